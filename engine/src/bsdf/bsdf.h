// SPDX-License-Identifier: GPL-3.0-or-later
// A surface's BSDF: a weighted sum of lobes. See bsdf/sample.h for the conventions.
#pragma once

#include "bsdf/baseline_metal.h"
#include "bsdf/conductor.h"
#include "bsdf/lambert.h"
#include "bsdf/mirror.h"
#include "bsdf/sample.h"

#include <optional>
#include <span>
#include <variant>

namespace glimmer {

using Lobe = std::variant<Lambert, Mirror, Conductor, BaselineMetal>;

struct WeightedLobe {
    Lobe lobe;
    float weight;      ///< factor of the lobe in the sum, >= 0
    float probability; ///< probability of sampling it; sums to 1 over a Bsdf (see set_probabilities)
};

/// A view; the lobes live in the scene. May be empty (black).
using Bsdf = std::span<const WeightedLobe>;

inline bool is_specular(const Lobe &lobe) {
    return std::visit([](const auto &l) { return is_specular(l); }, lobe);
}
inline Rgb albedo(const Lobe &lobe) {
    return std::visit([](const auto &l) { return albedo(l); }, lobe);
}
inline float max_value(const Lobe &lobe) {
    return std::visit([](const auto &l) { return max_value(l); }, lobe);
}
inline Rgb eval(const Lobe &lobe, const Vec3f &wo, const Vec3f &wi) {
    return std::visit([&](const auto &l) { return eval(l, wo, wi); }, lobe);
}
inline float pdf(const Lobe &lobe, const Vec3f &wo, const Vec3f &wi) {
    return std::visit([&](const auto &l) { return pdf(l, wo, wi); }, lobe);
}
inline std::optional<BsdfSample> sample(const Lobe &lobe, const Vec3f &wo, Vec2f u) {
    return std::visit([&](const auto &l) { return sample(l, wo, u); }, lobe);
}

/// f |cos_i| of the smooth lobes.
inline Rgb eval(Bsdf bsdf, const Vec3f &wo, const Vec3f &wi) {
    Rgb sum;
    for (const WeightedLobe &l : bsdf)
        sum += eval(l.lobe, wo, wi) * l.weight;
    return sum;
}

/// Density with which sample() returns wi from a smooth lobe.
inline float pdf(Bsdf bsdf, const Vec3f &wo, const Vec3f &wi) {
    float sum = 0;
    for (const WeightedLobe &l : bsdf)
        if (l.probability > 0)
            sum += pdf(l.lobe, wo, wi) * l.probability;
    return sum;
}

/// A direction of a smooth lobe comes with the weight of all smooth lobes, eval/pdf; one of a specular lobe with that
/// lobe's own weight over its probability.
inline std::optional<BsdfSample> sample(Bsdf bsdf, const Vec3f &wo, float u_lobe, Vec2f u) {
    const WeightedLobe *chosen = nullptr;
    int smooth = 0;
    for (const WeightedLobe &l : bsdf) {
        smooth += !is_specular(l.lobe);
        if (l.probability > 0 && u_lobe >= 0) {
            chosen = &l; // the last possible one stands if rounding lets u_lobe outlast the sum
            u_lobe -= l.probability;
        }
    }
    if (!chosen)
        return std::nullopt;
    std::optional<BsdfSample> s = sample(chosen->lobe, wo, u);
    if (!s)
        return std::nullopt;
    if (s->specular || smooth == 1) {
        s->weight *= chosen->weight / chosen->probability;
        s->pdf *= chosen->probability;
        return s;
    }
    const float density = pdf(bsdf, wo, s->wi);
    if (!(density > 0))
        return std::nullopt;
    return BsdfSample{s->wi, eval(bsdf, wo, s->wi) / density, density, false};
}

/// Delta lobes alone: light sampling finds nothing here.
inline bool is_specular(Bsdf bsdf) {
    for (const WeightedLobe &l : bsdf)
        if (!is_specular(l.lobe))
            return false;
    return true;
}
inline bool has_specular(Bsdf bsdf) {
    for (const WeightedLobe &l : bsdf)
        if (is_specular(l.lobe))
            return true;
    return false;
}

/// No f cos_o of any channel is larger: what bounds the light that a surface can throw at a point. Infinite with
/// mirrors.
inline float max_value(Bsdf bsdf) {
    float sum = 0;
    for (const WeightedLobe &l : bsdf)
        if (l.weight > 0)
            sum += l.weight * max_value(l.lobe);
    return sum;
}

/// Reflectance for the albedo AOV: an approximation that knows no direction.
inline Rgb albedo(Bsdf bsdf) {
    Rgb sum;
    for (const WeightedLobe &l : bsdf)
        sum += albedo(l.lobe) * l.weight;
    return sum;
}

/// Sets the probabilities of selection: nine tenths by weight times largest albedo, one tenth shared equally by the
/// lobes that have weight (a metal that is black at normal incidence is not at grazing).
inline void set_probabilities(std::span<WeightedLobe> lobes) {
    float total = 0;
    int count = 0;
    for (const WeightedLobe &l : lobes) {
        total += l.weight * max_component(albedo(l.lobe));
        count += l.weight > 0;
    }
    for (WeightedLobe &l : lobes) {
        if (!(l.weight > 0))
            l.probability = 0;
        else if (total > 0)
            l.probability = 0.9f * l.weight * max_component(albedo(l.lobe)) / total + 0.1f / static_cast<float>(count);
        else
            l.probability = 1 / static_cast<float>(count);
    }
}

} // namespace glimmer
