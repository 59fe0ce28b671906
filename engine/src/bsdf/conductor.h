// SPDX-License-Identifier: GPL-3.0-or-later
// Rough metal: Cook-Torrance with GGX; a mirror below kSmoothAlpha.
#pragma once

#include "bsdf/fresnel.h"
#include "bsdf/ggx.h"
#include "bsdf/sample.h"

#include <optional>

namespace glimmer {

struct Conductor {
    float alpha = 0;     ///< GGX width, 0 to 1
    bool use_f0 = false; ///< Schlick's approximation from f0 to f90, in place of eta and k
    Rgb eta, k, f0;
    Masking masking = Masking::Smith;
    Rgb f90 = Rgb(1);
};

inline bool is_specular(const Conductor &lobe) {
    return lobe.alpha < kSmoothAlpha;
}
inline Rgb fresnel(const Conductor &lobe, float cos_i) {
    return lobe.use_f0 ? fresnel_schlick(cos_i, lobe.f0, lobe.f90) : fresnel_conductor(cos_i, lobe.eta, lobe.k);
}
/// Reflectance at normal incidence: an approximation of the directional albedo.
inline Rgb albedo(const Conductor &lobe) {
    return fresnel(lobe, 1);
}

/// No f cos_o of any channel is larger: D <= 1 / (pi alpha^2), V cos_o <= 1 / (2 alpha) for each kind of masking, F
/// <= 1.
inline float max_value(const Conductor &lobe) {
    return is_specular(lobe) ? kInfinity : 1 / (2 * kPi * lobe.alpha * lobe.alpha * lobe.alpha);
}

inline Rgb eval(const Conductor &lobe, const Vec3f &wo, const Vec3f &wi) {
    if (is_specular(lobe) || !(wi.z > 0))
        return {};
    const Vec3f h = half_vector(wo, wi);
    const float cos_h = std::min(1.0f, dot(wo, h));
    return fresnel(lobe, cos_h) * (ggx_d(h, lobe.alpha) * ggx_visibility(wo, wi, lobe.alpha, lobe.masking) * wi.z);
}
inline float pdf(const Conductor &lobe, const Vec3f &wo, const Vec3f &wi) {
    if (is_specular(lobe) || !(wi.z > 0))
        return 0;
    return ggx_reflection_pdf(wo, half_vector(wo, wi), lobe.alpha);
}
inline std::optional<BsdfSample> sample(const Conductor &lobe, const Vec3f &wo, Vec2f u) {
    if (is_specular(lobe))
        return BsdfSample{{-wo.x, -wo.y, wo.z}, fresnel(lobe, wo.z), 1, true};
    const Vec3f h = sample_ggx_normal(wo, lobe.alpha, u);
    const Vec3f wi = reflect(wo, h);
    if (!(wi.z > 0))
        return std::nullopt;
    // D cancels: f cos_i / pdf = F V cos_i 2 (k cos_o + sqrt(alpha^2 sin_o^2 + cos_o^2)).
    const float d_over_pdf = 2 * (ggx_bound(wo, lobe.alpha) * wo.z + ggx_projected(wo, lobe.alpha));
    const float cos_h = std::min(1.0f, dot(wo, h));
    return BsdfSample{wi, fresnel(lobe, cos_h) * (ggx_visibility(wo, wi, lobe.alpha, lobe.masking) * wi.z * d_over_pdf),
                      ggx_d(h, lobe.alpha) / d_over_pdf, false};
}

} // namespace glimmer
