// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/light_set.h"

#include "sampling/defensive_mixture.h"

#include <cmath>

namespace glimmer {

namespace {

constexpr float kGuided = 0.9f; // the rest is uniform: a bound can underflow, or miss a light's rim

/// Draws from `weights` mixed with the uniform distribution. n >= 1.
template <class Weigh>
LightChoice choose_by(uint32_t n, float u, std::array<float, LightSet::kWeighedLights> &weights, const Weigh &weigh) {
    float total = 0;
    for (uint32_t i = 0; i < n; ++i)
        total += weights[i] = weigh(i);
    const DefensiveMixture mixture(total, n, 1 - kGuided);
    float left = u;
    for (uint32_t i = 0;; ++i) {
        const float p = mixture.probability(weights[i]);
        if (left < p || i + 1 == n)
            return {i, p};
        left -= p;
    }
}

template <class Weigh>
float probability_by(uint32_t n, uint32_t light, const Weigh &weigh) {
    float total = 0, own = 0;
    for (uint32_t i = 0; i < n; ++i) {
        const float w = weigh(i);
        total += w;
        if (i == light)
            own = w;
    }
    return DefensiveMixture(total, n, 1 - kGuided).probability(own);
}

} // namespace

LightSet::LightSet(std::vector<Light> lights, std::vector<LightFlags> flags, const VaryingEmission *varying)
    : lights_(std::move(lights)), flags_(std::move(flags)), varying_(varying) {
    std::vector<double> strengths;
    for (uint32_t i = 0; i < lights_.size(); ++i) {
        const Light &light = lights_[i];
        bounds_.push_back(bound_light(light));
        bounds_.back().strength *= flags_[i].profile_mean;
        strengths.push_back(double(bounds_.back().strength));
        std::visit(
            [&](const auto &l) {
                if constexpr (std::decay_t<decltype(l)>::traits.in_bvh)
                    claim_surfaces(l, i);
                if constexpr (std::decay_t<decltype(l)>::traits.infinite)
                    infinite_.push_back(i);
                if constexpr (std::decay_t<decltype(l)>::traits.intersectable)
                    intersectable_lamps_.push_back(i);
            },
            light);
    }
    if (size() > kWeighedLights) {
        double total = 0;
        for (double s : strengths)
            total += s;
        for (double &s : strengths)
            s = total > 0 ? double(kGuided) * s / total + double(1 - kGuided) / size() : 1.0;
        by_strength_ = AliasTable(strengths);
    }
}

void LightSet::claim_surfaces(const SphereLight &light, uint32_t index) {
    if (light.index >= of_sphere_.size())
        of_sphere_.resize(light.index + 1, kNone);
    of_sphere_[light.index] = index;
}

void LightSet::claim_surfaces(const MeshLight &, uint32_t index) {
    mesh_light_ = index;
}

float LightSet::importance_at_point(uint32_t light, const Vec3f &x, float sigma) const {
    const LightBound &b = bounds_[light];
    if (b.infinite)
        return sigma > 0 ? 0 : b.strength;
    const float d2 = length_squared(b.center - x);
    const float d = std::sqrt(d2);
    return b.strength / std::max(std::max(d2, b.radius * b.radius), 1e-30f) *
           std::exp(-sigma * std::max(d - b.radius, 0.0f));
}

float LightSet::importance_along_segment(uint32_t light, const Vec3f &origin, const Vec3f &direction, float t_max,
                                         float sigma) const {
    const LightBound &b = bounds_[light];
    if (b.infinite)
        return 0;
    const Vec3f to_center = b.center - origin;
    const float foot = dot(to_center, direction);
    const float h2 = length_squared(cross(to_center, direction)) + 0.25f * b.radius * b.radius;
    const float h = std::sqrt(std::max(h2, 1e-12f * length_squared(to_center)));
    if (!(h > 0))
        return b.strength;
    // The angle between the ends of the segment as seen from the light; exact digits do not matter here.
    const float angle = std::isinf(t_max) ? std::atan2(h, -foot) : std::atan2(h * t_max, h * h + foot * (foot - t_max));
    return b.strength * angle / h * std::exp(-sigma * std::max(length(to_center) - b.radius, 0.0f));
}

LightChoice LightSet::choose(const Vec3f &x, float sigma, float u) const {
    if (!by_strength_.empty()) {
        const AliasSample s = by_strength_.sample(u);
        return {s.index, s.pmf};
    }
    Weights weights;
    return choose_by(size(), u, weights, [&](uint32_t i) { return importance_at_point(i, x, sigma); });
}

float LightSet::probability(uint32_t light, const Vec3f &x, float sigma) const {
    if (!by_strength_.empty())
        return by_strength_.pmf(light);
    return probability_by(size(), light, [&](uint32_t i) { return importance_at_point(i, x, sigma); });
}

LightChoice LightSet::choose(const Vec3f &origin, const Vec3f &direction, float t_max, float sigma, float u) const {
    if (!by_strength_.empty()) {
        const AliasSample s = by_strength_.sample(u);
        return {s.index, s.pmf};
    }
    Weights weights;
    return choose_by(size(), u, weights,
                     [&](uint32_t i) { return importance_along_segment(i, origin, direction, t_max, sigma); });
}

float LightSet::probability(uint32_t light, const Vec3f &origin, const Vec3f &direction, float t_max,
                            float sigma) const {
    if (!by_strength_.empty())
        return by_strength_.pmf(light);
    return probability_by(size(), light,
                          [&](uint32_t i) { return importance_along_segment(i, origin, direction, t_max, sigma); });
}

} // namespace glimmer
