// SPDX-License-Identifier: GPL-3.0-or-later
// Rough reflection: Cook-Torrance with GGX, of metals or of the boundary of a dielectric that light does not enter; a
// mirror below kSmoothAlpha.
#pragma once

#include "bsdf/fresnel.h"
#include "bsdf/ggx.h"
#include "bsdf/ggx_albedo.h"
#include "bsdf/sample.h"

#include <optional>

namespace glimmer {

struct Conductor {
    float alpha = 0;     ///< GGX width, 0 to 1
    bool use_f0 = false; ///< a curve from f0 to f90, in place of eta and k
    Rgb eta, k, f0;
    Masking masking = Masking::Smith;
    Rgb f90 = Rgb(1);
    Rgb f82 = Rgb(1);                 ///< Schlick's curve is multiplied by this near grazing
    float ior = 0;                    ///< the curve is that of a dielectric of this index; 0: Schlick's
    bool multiple_scattering = false; ///< what facets send on to each other is added
};

inline bool is_specular(const Conductor &lobe) {
    return lobe.alpha < kSmoothAlpha;
}
/// Of all curves but Schlick's. Not inlined: there the one that most metals have would lose its registers to them.
[[gnu::noinline]] inline Rgb other_fresnel(const Conductor &lobe, float cos_i) {
    if (!lobe.use_f0)
        return fresnel_conductor(cos_i, lobe.eta, lobe.k);
    if (lobe.ior > 0)
        return lobe.f0 + (lobe.f90 - lobe.f0) * fresnel_rise(cos_i, lobe.ior);
    const Rgb schlick = fresnel_schlick(cos_i, lobe.f0, lobe.f90);
    const float rest2 = (1 - cos_i) * (1 - cos_i);
    const Rgb dipped = schlick - fresnel_f82_dip(lobe.f0, lobe.f90, lobe.f82) * (cos_i * rest2 * rest2 * rest2);
    return {std::max(dipped.r, 0.0f), std::max(dipped.g, 0.0f), std::max(dipped.b, 0.0f)};
}
inline Rgb fresnel(const Conductor &lobe, float cos_i) {
    if (lobe.use_f0 && !(lobe.ior > 0) && lobe.f82 == Rgb(1)) [[likely]]
        return fresnel_schlick(cos_i, lobe.f0, lobe.f90);
    return other_fresnel(lobe, cos_i);
}
/// Reflectance of a facet over all directions, weighted by their cosines. Exact eta and k are taken by the curve
/// through their reflectance at normal incidence and at 82 degrees.
inline Rgb mean_fresnel(const Conductor &lobe) {
    if (lobe.use_f0 && lobe.ior > 0) {
        const float r = (lobe.ior - 1) / (lobe.ior + 1), f0 = r * r;
        return lobe.f0 +
               (lobe.f90 - lobe.f0) * std::clamp((mean_fresnel_dielectric(lobe.ior) - f0) / (1 - f0), 0.0f, 1.0f);
    }
    const Rgb f0 = fresnel(lobe, 1), f90 = lobe.use_f0 ? lobe.f90 : Rgb(1);
    Rgb dip;
    if (!lobe.use_f0)
        dip = (fresnel_schlick(1.0f / 7, f0) - fresnel(lobe, 1.0f / 7)) * (7 / (46656.0f / 117649));
    else if (!(lobe.f82 == Rgb(1)))
        dip = fresnel_f82_dip(f0, f90, lobe.f82);
    return f0 + (f90 - f0) * (1 / 21.0f) - dip * (1 / 126.0f); // 2 int mu (1 - mu)^5, 2 int mu^2 (1 - mu)^6
}
[[gnu::noinline]] inline Rgb multiple_scattering_scale(const Conductor &lobe, const Vec3f &wo) {
    return multiple_scattering_scale(ggx_albedo(wo.z, lobe.alpha), mean_ggx_albedo(lobe.alpha), mean_fresnel(lobe));
}
/// An approximation of the directional albedo: reflectance at normal incidence; of a dielectric, which reflects most of
/// its light at grazing, the mean.
inline Rgb albedo(const Conductor &lobe) {
    return lobe.use_f0 && lobe.ior > 0 ? mean_fresnel(lobe) : fresnel(lobe, 1);
}
/// Part of the light towards wo that the lobe sends there, and keeps from what lies beneath: its directional albedo, of
/// metals by the reflectance of a facet in the middle.
inline Rgb coverage(const Conductor &lobe, const Vec3f &wo) {
    if (is_specular(lobe))
        return fresnel(lobe, wo.z);
    const bool rises = lobe.use_f0 && lobe.ior > 0;
    const Rgb facets =
        rises ? lobe.f0 + (lobe.f90 - lobe.f0) * mean_fresnel_rise(wo.z, lobe.alpha, lobe.ior) : fresnel(lobe, wo.z);
    const Rgb once = facets * ggx_albedo(wo.z, lobe.alpha);
    return lobe.multiple_scattering ? once * multiple_scattering_scale(lobe, wo) : once;
}

/// No f cos_o of any channel is larger: D <= 1 / (pi alpha^2), V cos_o <= 1 / (2 alpha) for each kind of masking, F
/// <= 1.
inline float max_value(const Conductor &lobe) {
    if (is_specular(lobe))
        return kInfinity;
    const float once = 1 / (2 * kPi * lobe.alpha * lobe.alpha * lobe.alpha);
    return lobe.multiple_scattering ? once * max_multiple_scattering_scale(lobe.alpha) : once;
}

/// The reflectance of facets that light leaves to wo by.
inline Rgb facet_reflectance(const Conductor &lobe, const Vec3f &wo, float cos_h) {
    const Rgb f = fresnel(lobe, cos_h);
    if (lobe.multiple_scattering) [[unlikely]]
        return f * multiple_scattering_scale(lobe, wo);
    return f;
}

inline Rgb eval(const Conductor &lobe, const Vec3f &wo, const Vec3f &wi) {
    if (is_specular(lobe) || !(wi.z > 0))
        return {};
    const Vec3f h = half_vector(wo, wi);
    const float cos_h = std::min(1.0f, dot(wo, h));
    return facet_reflectance(lobe, wo, cos_h) *
           (ggx_d(h, lobe.alpha) * ggx_visibility(wo, wi, lobe.alpha, lobe.masking) * wi.z);
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
    return BsdfSample{
        wi, facet_reflectance(lobe, wo, cos_h) * (ggx_visibility(wo, wi, lobe.alpha, lobe.masking) * wi.z * d_over_pdf),
        ggx_d(h, lobe.alpha) / d_over_pdf, false};
}

} // namespace glimmer
