// SPDX-License-Identifier: GPL-3.0-or-later
// The metal of the student report: the plain sum of a diffuse and a Cook-Torrance lobe. Not energy conserving (its
// albedo reaches 1.86); kept to compare with.
#pragma once

#include "bsdf/fresnel.h"
#include "bsdf/ggx.h"
#include "bsdf/lambert.h"
#include "bsdf/sample.h"

#include <algorithm>
#include <optional>

namespace glimmer {

struct BaselineMetal {
    Rgb albedo, f0;
    float alpha = 0; ///< GGX width; used as at least kSmoothAlpha
};

inline bool is_specular(const BaselineMetal &) {
    return false;
}
inline Rgb albedo(const BaselineMetal &lobe) {
    return lobe.albedo + lobe.f0;
}

/// No f cos_o of any channel is larger (see Conductor).
inline float max_value(const BaselineMetal &lobe) {
    const float alpha = std::max(lobe.alpha, kSmoothAlpha);
    return max_component(lobe.albedo) / kPi + 1 / (2 * kPi * alpha * alpha * alpha);
}

/// Probability of sampling the diffuse lobe: by reflectance, with a tenth of it shared equally, since Schlick's term
/// grows from any f0.
inline float diffuse_probability(const BaselineMetal &lobe) {
    const float diffuse = max_component(lobe.albedo), glossy = max_component(lobe.f0);
    return diffuse > 0 ? 0.9f * diffuse / (diffuse + glossy) + 0.05f : 0;
}

inline Rgb eval(const BaselineMetal &lobe, const Vec3f &wo, const Vec3f &wi) {
    if (!(wi.z > 0))
        return {};
    const float alpha = std::max(lobe.alpha, kSmoothAlpha);
    const Vec3f h = half_vector(wo, wi);
    const float glossy = ggx_d(h, alpha) * ggx_visibility(wo, wi, alpha, Masking::SchlickGgx) * wi.z;
    return lobe.albedo * pdf_cosine_hemisphere(wi.z) + fresnel_schlick(dot(wo, h), lobe.f0) * glossy;
}
inline float pdf(const BaselineMetal &lobe, const Vec3f &wo, const Vec3f &wi) {
    if (!(wi.z > 0))
        return 0;
    const float p = diffuse_probability(lobe), alpha = std::max(lobe.alpha, kSmoothAlpha);
    return p * pdf_cosine_hemisphere(wi.z) + (1 - p) * ggx_reflection_pdf(wo, half_vector(wo, wi), alpha);
}
inline std::optional<BsdfSample> sample(const BaselineMetal &lobe, const Vec3f &wo, Vec2f u) {
    const float p = diffuse_probability(lobe);
    Vec3f wi;
    if (u.x < p)
        wi = sample_cosine_hemisphere({std::min(u.x / p, 0x1.fffffep-1f), u.y});
    else
        wi = reflect(wo, sample_ggx_normal(wo, std::max(lobe.alpha, kSmoothAlpha), {(u.x - p) / (1 - p), u.y}));
    const float density = pdf(lobe, wo, wi);
    if (!(wi.z > 0) || !(density > 0))
        return std::nullopt;
    return BsdfSample{wi, eval(lobe, wo, wi) / density, density, false};
}

} // namespace glimmer
