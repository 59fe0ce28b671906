// SPDX-License-Identifier: GPL-3.0-or-later
// Rough diffuse reflection: Oren and Nayar's (1994) in Fujii's form, which neither darkens nor breaks at grazing angles
// ("A tiny improvement of Oren-Nayar reflectance model", 2012), alone or with the light that its facets send on to
// each other (Portsmouth, Kutz, Hill 2024, "EON: A practical energy-preserving rough diffuse BRDF").
#pragma once

#include "bsdf/sample.h"
#include "sampling/warp.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace glimmer {

struct OrenNayar {
    Rgb albedo;                       ///< of a facet
    float roughness = 0;              ///< 0 to 1; 0 is Lambert's lobe
    bool multiple_scattering = false; ///< what facets send on to each other is added
    bool tinted = false;              ///< that light has the albedo once more, as in Cycles: darker than energy allows

    /// 1 / (pi + (pi/2 - 2/3) roughness): f of single scattering is albedo a (1 + roughness s / t).
    float a() const { return 1 / (kPi + (kPi / 2 - 2.0f / 3) * roughness); }
};

/// Reflectance of white facets towards a direction of this cosine, light scattered once: integral of f cos.
inline float single_albedo(const OrenNayar &lobe, float cosine) {
    const float mu = std::clamp(cosine, 0.0f, 1.0f), sine = std::sqrt((1 - mu) * (1 + mu));
    // G / sine stays finite at mu = 1, where (1 - sine^3) / mu does not vanish but sine does, and at mu = 0, where
    // 1 - sine^3 does: (1 - s^3) / mu = mu (1 + s + s^2) / (1 + s).
    const float g =
        sine * (std::acos(mu) - sine * mu) + 2.0f / 3 * (sine * mu * (1 + sine + sine * sine) / (1 + sine) - sine);
    return lobe.a() * (kPi + lobe.roughness * g);
}
/// Its mean over cosine-weighted directions.
inline float mean_single_albedo(const OrenNayar &lobe) {
    return lobe.a() * (kPi + lobe.roughness * (2 * kPi - 5.6f) / 3);
}

inline Rgb eval(const OrenNayar &lobe, const Vec3f &wo, const Vec3f &wi) {
    if (!(wi.z > 0))
        return {};
    const float s = dot(wo, wi) - wo.z * wi.z, ratio = s > 0 ? s / std::max(wo.z, wi.z) : s;
    Rgb f = lobe.albedo * (lobe.a() * (1 + lobe.roughness * ratio));
    if (lobe.multiple_scattering) {
        const float mean = mean_single_albedo(lobe), lost = 1 - mean;
        const float there = 1 - single_albedo(lobe, wo.z), back = 1 - single_albedo(lobe, wi.z);
        for (int c = 0; c < 3; ++c)
            f[c] += lobe.albedo[c] * lobe.albedo[c] * mean / (1 - lobe.albedo[c] * lost) / kPi *
                    (lost > 0 ? there * back / lost : 0) * (lobe.tinted ? lobe.albedo[c] : 1);
    }
    return f * wi.z;
}
inline float pdf(const OrenNayar &, const Vec3f &, const Vec3f &wi) {
    return pdf_cosine_hemisphere(wi.z);
}
inline std::optional<BsdfSample> sample(const OrenNayar &lobe, const Vec3f &wo, Vec2f u) {
    const Vec3f wi = sample_cosine_hemisphere(u);
    const float density = pdf_cosine_hemisphere(wi.z);
    if (!(density > 0))
        return std::nullopt;
    return BsdfSample{wi, eval(lobe, wo, wi) / density, density, false};
}
inline bool is_specular(const OrenNayar &) {
    return false;
}
inline Rgb albedo(const OrenNayar &lobe) {
    return lobe.albedo;
}
/// No f cos_o of any channel is larger: s / t <= 1, and what facets send on to each other is at most what is lost.
inline float max_value(const OrenNayar &lobe) {
    const float once = lobe.a() * (1 + lobe.roughness);
    return max_component(lobe.albedo) * (once + (lobe.multiple_scattering ? 1 / kPi : 0));
}

} // namespace glimmer
