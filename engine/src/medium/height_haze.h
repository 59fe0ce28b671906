// SPDX-License-Identifier: GPL-3.0-or-later
// Haze that thins out exponentially with height, everywhere: the air above a planet. Along a ray it is a homogeneous
// medium by another length (docs/method.md, section 16), so all of its formulas are closed.
#pragma once

#include "geometry/ray.h"
#include "medium/homogeneous_medium.h"

#include <algorithm>
#include <cmath>

namespace glimmer {

class HeightHaze {
  public:
    /// at_origin: what it is at height 0 of the scene's space, where z is up. scale_height > 0: per so much height it
    /// thins out by e.
    HeightHaze(const HomogeneousMedium &at_origin, float scale_height)
        : monochromatic(at_origin.monochromatic), g(at_origin.g), at_origin_(at_origin), per_height_(1 / scale_height) {
    }

    /// The length of a homogeneous medium, as dense as this one at the ray's origin, that the length t of the ray
    /// amounts to: (1 - e^(-b t)) / b where the density falls as e^(-b t).
    float amount(const Ray &ray, float t) const {
        const float b = fall(ray), x = b * t;
        if (b == 0 || t == 0)
            return t;
        if (b > 0)
            return one_minus_exp(x) / b;
        return t < kInfinity ? std::expm1(-x) / -b : kInfinity;
    }
    /// The other way round; amount below amount(ray, infinity).
    float length_of(const Ray &ray, float amount) const {
        const float b = fall(ray), x = b * amount;
        if (b == 0 || amount == 0)
            return amount;
        return x < 1 ? -std::log1p(-x) / b : kInfinity;
    }
    /// The medium as it is at the ray's origin.
    HomogeneousMedium local(const Ray &ray) const {
        const float density = std::min(std::exp(-per_height_ * ray.origin.z), kMost);
        return {at_origin_.sigma_a * density, at_origin_.sigma_s * density, g};
    }
    /// The density t along the ray over that at its origin.
    float density(const Ray &ray, float t) const { return std::min(std::exp(-fall(ray) * t), kMost); }

    bool scatters() const { return at_origin_.scatters(); }
    Rgb transmittance(const Ray &ray, float t) const { return local(ray).transmittance(amount(ray, t)); }
    Rgb transmittance(const Ray &first, float t, const Ray &second, float t_second) const {
        return transmittance(first, t) * transmittance(second, t_second);
    }
    Rgb scattering(const Ray &ray, float t) const { return local(ray).sigma_s * density(ray, t); }
    float least_absorbed(const Ray &ray, float t) const { return local(ray).least_absorbed(ray, amount(ray, t)); }

    // One number each, as it is about the camera. High up there is nothing.
    float least_extinction() const { return 0; }
    float least_scattering_extinction() const { return at_origin_.least_scattering_extinction(); }
    float majorant() const { return at_origin_.majorant(); }
    float mean_extinction() const { return at_origin_.mean_extinction(); }
    float effective_attenuation() const { return at_origin_.effective_attenuation(); }
    float return_probability(float, float) const { return 1; }
    const HomogeneousMedium &at_origin() const { return at_origin_; }

    bool monochromatic;
    float g;

  private:
    static constexpr float kMost = 1e18f;
    float fall(const Ray &ray) const { return per_height_ * ray.direction.z; }

    HomogeneousMedium at_origin_;
    float per_height_;
};

inline SimdMedium simd_view(const HeightHaze &m) {
    return simd_view(m.at_origin());
}

// As Medium asks for them: those of the homogeneous medium, by its length.
inline FreeFlight sample_free_flight(const HeightHaze &m, const Ray &ray, const Rgb &beta, float t_max,
                                     Sampler &sampler) {
    FreeFlight flight = sample_free_flight(m.local(ray), beta, m.amount(ray, t_max), sampler);
    flight.t = flight.scattered ? std::min(m.length_of(ray, flight.t), t_max) : t_max;
    if (flight.scattered)
        flight.pdf *= m.density(ray, flight.t);
    if (flight.scattered && !(flight.t < kInfinity)) // so high up that it may as well have passed
        flight = {t_max, true, Rgb(0), 0};
    return flight;
}
inline float free_flight_pdf(const HeightHaze &m, const Ray &ray, const Rgb &beta, float t) {
    return free_flight_pdf(m.local(ray), beta, m.amount(ray, t)) * m.density(ray, t);
}
inline Collision at_length(const HeightHaze &m, const Ray &ray, float t_max, Collision c) {
    c.t = std::min(m.length_of(ray, c.t), t_max);
    c.pdf *= m.density(ray, c.t);
    return c.t < kInfinity ? c : Collision{0, Rgb(0), 0};
}
inline Collision sample_collision(const HeightHaze &m, const Ray &ray, const Rgb &beta, float t_max, float u_channel,
                                  uint64_t bits_t) {
    const float amount = m.amount(ray, t_max);
    return at_length(m, ray, t_max, sample_collision(m.local(ray), beta, amount, u_channel, bits_t));
}
inline Collision sample_collision(const HeightHaze &m, const Ray &ray, const Rgb &beta, float t_max, Sampler &sampler) {
    return at_length(m, ray, t_max, sample_collision(m.local(ray), beta, m.amount(ray, t_max), sampler));
}
inline float collision_pdf(const HeightHaze &m, const Ray &ray, const Rgb &beta, float t_max, float t) {
    if (!(t >= 0 && t <= t_max))
        return 0;
    return collision_pdf(m.local(ray), beta, m.amount(ray, t_max), m.amount(ray, t)) * m.density(ray, t);
}

} // namespace glimmer
