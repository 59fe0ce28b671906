// SPDX-License-Identifier: GPL-3.0-or-later
// A medium of constant coefficients: transmittance, and the sampling of distances.
#pragma once

#include "geometry/ray.h"
#include "math/simd/float8.h"
#include "math/vec.h"
#include "medium/simd_medium.h"
#include "sampling/exponential.h"
#include "sampling/sampler.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace glimmer {

/// Optical depth of a distance, where nothing times infinity is nothing.
inline float optical_depth(float sigma, float t) {
    return sigma > 0 ? sigma * t : 0;
}

/// Coefficients per unit length, g of Henyey-Greenstein.
struct HomogeneousMedium {
    Rgb sigma_a, sigma_s, sigma_t;
    float g = 0;
    bool monochromatic = true; ///< sigma_a and sigma_s are each the same in all channels

    HomogeneousMedium() = default;
    HomogeneousMedium(const Rgb &absorption, const Rgb &scattering, float g_)
        : sigma_a(absorption), sigma_s(scattering), sigma_t(absorption + scattering), g(g_),
          monochromatic(sigma_a == Rgb(sigma_a.r) && sigma_s == Rgb(sigma_s.r)) {}

    bool scatters() const { return !is_black(sigma_s); }

    /// e^(-sigma_t t); t >= 0, possibly infinite.
    Rgb transmittance(float t) const {
        if (monochromatic)
            return Rgb(std::exp(-optical_depth(sigma_t.r, t)));
        return exp_minus({optical_depth(sigma_t.r, t), optical_depth(sigma_t.g, t), optical_depth(sigma_t.b, t)});
    }

    // As Medium asks for them; the place makes no difference.
    Rgb transmittance(const Ray &, float t) const { return transmittance(t); }
    Rgb transmittance(const Ray &, float t, const Ray &, float t_second) const { return transmittance(t + t_second); }
    Rgb scattering(const Ray &, float) const { return sigma_s; }
    float least_absorbed(const Ray &, float t) const { return std::exp(-optical_depth(least_absorption(), t)); }

    float least_extinction() const { return std::min(sigma_t.r, std::min(sigma_t.g, sigma_t.b)); }
    float least_scattering_extinction() const {
        return least_of_scattering([](float, float t) { return t; });
    }
    float majorant() const { return max_component(sigma_t); }
    float mean_extinction() const { return (sigma_t.r + sigma_t.g + sigma_t.b) / 3; }
    float least_absorption() const { return std::min(sigma_a.r, std::min(sigma_a.g, sigma_a.b)); }
    float effective_attenuation() const {
        const float least = least_of_scattering(diffuse_attenuation);
        return least < kInfinity ? least : 0;
    }

    /// (R / r)^2 e^(-kappa (r - R)) of a sphere that is a mean free path larger; no path dies faster than on its way.
    float return_probability(float radius, float distance) const {
        float most = 0; // of the channels: a path goes on in whichever carries it furthest
        for (int c = 0; c < 3; ++c) {
            if (!(sigma_s[c] > 0))
                continue;
            const float reach = radius + 1 / sigma_t[c];
            if (distance <= reach)
                return 1;
            const float kappa = std::min(diffuse_attenuation(sigma_s[c], sigma_t[c]), sigma_t[c]);
            const float ratio = reach / distance;
            most = std::max(most, ratio * ratio * std::exp(-kappa * (distance - reach)));
        }
        return most;
    }

  private:
    /// kappa of one channel in the diffusion approximation: sqrt(3 (1 - albedo)) sigma_t.
    static float diffuse_attenuation(float s, float t) { return std::sqrt(3 * std::max(1 - s / t, 0.0f)) * t; }

    /// Infinite where no channel scatters.
    template <class Function>
    float least_of_scattering(const Function &function) const {
        float least = kInfinity;
        for (int c = 0; c < 3; ++c)
            if (sigma_s[c] > 0)
                least = std::min(least, function(sigma_s[c], sigma_t[c]));
        return least;
    }
};

inline SimdMedium simd_view(const HomogeneousMedium &m) {
    return {m.sigma_t.r, m.sigma_t.g, m.sigma_t.b, m.g, m.monochromatic};
}

/// A free flight: a scattering at distance t, or none before t_max (then t = t_max).
struct FreeFlight {
    float t;
    bool scattered;
    Rgb weight; ///< sigma_s T(t) / pdf, or T(t_max) / pdf
    float pdf;  ///< per length, or the probability of passing
};

/// A scattering on a segment that is always split: t in [0, t_max].
struct Collision {
    float t;
    Rgb weight; ///< sigma_s T(t) / pdf
    float pdf;  ///< per length; 0 (with weight 0) when there is nothing to sample
};

namespace detail {

inline float sum(const Rgb &c) {
    return c.r + c.g + c.b;
}

/// The channel that u picks from unnormalised shares.
inline int pick_channel(const Rgb &share, float u) {
    u *= sum(share);
    if (u < share.r)
        return 0;
    if (u < share.r + share.g || !(share.b > 0))
        return share.g > 0 ? 1 : 0;
    return 2;
}

/// sum_c share_c scale_c e^(offset - depth_c), over the channels that have a share.
inline float mixture(const Rgb &share, const Rgb &scale, const Rgb &depth, float offset) {
    const Rgb parts = share * scale, left = exp_minus(depth - Rgb(offset));
    float p = 0;
    for (int c = 0; c < 3; ++c)
        if (parts[c] > 0)
            p += parts[c] * left[c];
    return p;
}

/// The smallest depth of a channel with a share: adding it before exponentiating keeps quotients of transmittances
/// finite where each alone is 0 (beyond a depth of 88 in float).
inline float least_depth(const Rgb &share, const Rgb &scale, const Rgb &depth) {
    float least = kInfinity;
    for (int c = 0; c < 3; ++c)
        if (share[c] * scale[c] > 0)
            least = std::min(least, depth[c]);
    return least;
}

inline Rgb depths(const Rgb &sigma, float t) {
    return {optical_depth(sigma.r, t), optical_depth(sigma.g, t), optical_depth(sigma.b, t)};
}

/// value_c e^(offset - depth_c) / p; 0 for a channel that carries no throughput, whose quotient has no bound.
inline Rgb weigh(const Rgb &beta, const Rgb &value, const Rgb &depth, float offset, float p) {
    const Rgb left = exp_minus(depth - Rgb(offset));
    Rgb w;
    for (int c = 0; c < 3; ++c)
        if (beta[c] > 0 && value[c] > 0 && depth[c] < kInfinity)
            w[c] = value[c] * left[c] / p;
    return w;
}

/// Shares of the channels in sample_collision: throughput times what the channel scatters on the segment.
inline Rgb collision_shares(const HomogeneousMedium &m, const Rgb &beta, float t_max) {
    Rgb share;
    for (int c = 0; c < 3; ++c)
        if (m.sigma_s[c] > 0)
            share[c] = beta[c] * (m.sigma_s[c] / m.sigma_t[c]) * one_minus_exp(m.sigma_t[c] * t_max);
    return share;
}

/// sigma_t / (1 - e^(-sigma_t t_max)), 0 where the channel has no share: densities at t = 0.
inline Rgb collision_densities(const HomogeneousMedium &m, const Rgb &share, float t_max) {
    Rgb density;
    for (int c = 0; c < 3; ++c)
        if (share[c] > 0)
            density[c] = m.sigma_t[c] / one_minus_exp(m.sigma_t[c] * t_max);
    return density;
}

} // namespace detail

/// Draws the distance to the next scattering. beta: throughput, >= 0, before the flight.
///
/// What is drawn is scattering alone, with density sigma_s e^(-sigma_s t); absorption is a factor. In one channel the
/// weights are e^(-sigma_a t) in both outcomes: at most 1, and without noise in the limit of a pure absorber, which
/// samples nothing. Of several channels the density is the mixture with shares beta_c / sum(beta). A channel that does
/// not scatter keeps its share and always passes: without it the light it carries past a thick medium of another
/// channel would have no bounded weight. In every channel beta_c weight_c <= sum(beta). A channel with beta_c = 0 gets
/// weight 0. bits_channel is not used by a monochromatic medium; bits_t as in truncated_exponential.
inline FreeFlight sample_free_flight(const HomogeneousMedium &m, const Rgb &beta, float t_max, float u_channel,
                                     uint64_t bits_t) {
    if (!m.scatters() || is_black(beta))
        return {t_max, false, m.transmittance(t_max), 1};
    if (m.monochromatic) {
        const float t = exponential(bits_t) / m.sigma_s.r;
        if (t < t_max)
            return {t, true, Rgb(std::exp(-m.sigma_a.r * t)), m.sigma_s.r * std::exp(-m.sigma_s.r * t)};
        return {t_max, false, Rgb(std::exp(-optical_depth(m.sigma_a.r, t_max))), std::exp(-m.sigma_s.r * t_max)};
    }
    const Rgb share = beta / detail::sum(beta);
    const float sigma = m.sigma_s[detail::pick_channel(share, u_channel)];
    const float t = sigma > 0 ? exponential(bits_t) / sigma : kInfinity;
    const bool scattered = t < t_max;
    const float end = scattered ? t : t_max;
    const Rgb scale = scattered ? m.sigma_s : Rgb(1), scattering = detail::depths(m.sigma_s, end);
    const float offset = detail::least_depth(share, scale, scattering);
    if (!(offset < kInfinity)) // past every depth: t overflowed
        return {end, scattered, Rgb(0), 0};
    const float p = detail::mixture(share, scale, scattering, offset);
    return {end, scattered, detail::weigh(beta, scale, detail::depths(m.sigma_t, end), offset, p),
            p * std::exp(-offset)};
}

inline FreeFlight sample_free_flight(const HomogeneousMedium &m, const Rgb &beta, float t_max, Sampler &sampler) {
    const float u = m.monochromatic ? 0 : sampler.next_1d();
    return sample_free_flight(m, beta, t_max, u, sampler.next_bits());
}

/// Density per length of a scattering at t < t_max in sample_free_flight.
inline float free_flight_pdf(const HomogeneousMedium &m, const Rgb &beta, float t) {
    if (!m.scatters() || is_black(beta))
        return 0;
    if (m.monochromatic)
        return m.sigma_s.r * std::exp(-m.sigma_s.r * t);
    return detail::mixture(beta / detail::sum(beta), m.sigma_s, detail::depths(m.sigma_s, t), 0);
}

/// Draws a scattering on [0, t_max] (t_max possibly infinite), given that there is one. In one channel the density is
/// sigma_t e^(-sigma_t t) / (1 - e^(-sigma_t t_max)), so the weight is the constant albedo (1 - e^(-sigma_t t_max)):
/// nothing is left to vary. Of several channels, the mixture with shares beta_c albedo_c (1 - e^(-sigma_t,c t_max)):
/// beta_c weight_c is at most their sum.
inline Collision sample_collision(const HomogeneousMedium &m, const Rgb &beta, float t_max, float u_channel,
                                  uint64_t bits_t) {
    if (m.monochromatic) {
        const float sigma = m.sigma_t.r, scattered = one_minus_exp(optical_depth(sigma, t_max));
        if (!(m.sigma_s.r > 0) || !(scattered > 0) || is_black(beta))
            return {0, Rgb(0), 0};
        const float t = std::min(truncated_exponential(bits_t, sigma * t_max) / sigma, t_max);
        if (!(t < kInfinity))
            return {0, Rgb(0), 0};
        return {t, Rgb(m.sigma_s.r / sigma * scattered), sigma * std::exp(-sigma * t) / scattered};
    }
    const Rgb share = detail::collision_shares(m, beta, t_max);
    const float total = detail::sum(share);
    if (!(total > 0))
        return {0, Rgb(0), 0};
    const Rgb density = detail::collision_densities(m, share, t_max);
    const float sigma = m.sigma_t[detail::pick_channel(share, u_channel)];
    const float t = std::min(truncated_exponential(bits_t, sigma * t_max) / sigma, t_max);
    if (!(t < kInfinity))
        return {0, Rgb(0), 0};
    const Rgb depth = detail::depths(m.sigma_t, t);
    const float offset = detail::least_depth(share, density, depth);
    const float p = detail::mixture(share / total, density, depth, offset);
    return {t, detail::weigh(beta, m.sigma_s, depth, offset, p), p * std::exp(-offset)};
}

inline Collision sample_collision(const HomogeneousMedium &m, const Rgb &beta, float t_max, Sampler &sampler) {
    const float u = m.monochromatic ? 0 : sampler.next_1d();
    return sample_collision(m, beta, t_max, u, sampler.next_bits());
}

/// Density per length of t in sample_collision.
inline float collision_pdf(const HomogeneousMedium &m, const Rgb &beta, float t_max, float t) {
    if (m.monochromatic) {
        const float scattered = one_minus_exp(optical_depth(m.sigma_t.r, t_max));
        if (!(m.sigma_s.r > 0) || !(scattered > 0) || is_black(beta) || !(t >= 0 && t <= t_max))
            return 0;
        return m.sigma_t.r * std::exp(-m.sigma_t.r * t) / scattered;
    }
    const Rgb share = detail::collision_shares(m, beta, t_max);
    const float total = detail::sum(share);
    if (!(total > 0) || !(t >= 0 && t <= t_max))
        return 0;
    return detail::mixture(share / total, detail::collision_densities(m, share, t_max), detail::depths(m.sigma_t, t),
                           0);
}

// As Medium asks for them: along a ray.
inline FreeFlight sample_free_flight(const HomogeneousMedium &m, const Ray &, const Rgb &beta, float t_max,
                                     Sampler &sampler) {
    return sample_free_flight(m, beta, t_max, sampler);
}
inline float free_flight_pdf(const HomogeneousMedium &m, const Ray &, const Rgb &beta, float t) {
    return free_flight_pdf(m, beta, t);
}
inline Collision sample_collision(const HomogeneousMedium &m, const Ray &, const Rgb &beta, float t_max,
                                  float u_channel, uint64_t bits_t) {
    return sample_collision(m, beta, t_max, u_channel, bits_t);
}
inline Collision sample_collision(const HomogeneousMedium &m, const Ray &, const Rgb &beta, float t_max,
                                  Sampler &sampler) {
    return sample_collision(m, beta, t_max, sampler);
}
inline float collision_pdf(const HomogeneousMedium &m, const Ray &, const Rgb &beta, float t_max, float t) {
    return collision_pdf(m, beta, t_max, t);
}

} // namespace glimmer
