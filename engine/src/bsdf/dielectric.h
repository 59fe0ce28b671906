// SPDX-License-Identifier: GPL-3.0-or-later
// The boundary of a dielectric body (glass, water): smooth, or rough with GGX (Walter, Marschner, Li, Torrance 2007,
// "Microfacet Models for Refraction through Rough Surfaces").
#pragma once

#include "bsdf/fresnel.h"
#include "bsdf/ggx.h"
#include "bsdf/ggx_albedo.h"
#include "bsdf/sample.h"
#include "math/vec.h"

#include <cmath>
#include <optional>

namespace glimmer {

struct Dielectric {
    float ior = 1.5f;                 ///< of the body, > 0
    float alpha = 0;                  ///< GGX width, 0 to 1; smooth below kSmoothAlpha
    bool schlick = false;             ///< Schlick's approximation in place of the exact reflectance
    bool reflects = true;             ///< else all light is refracted that can be, whatever Fresnel's equations say
    Rgb reflection = Rgb(1);          ///< colour of what is reflected
    Rgb transmission = Rgb(1);        ///< and of what is transmitted, at each crossing
    bool multiple_scattering = false; ///< what facets send on to each other is added
    Masking masking = Masking::Smith; ///< not SchlickGgx
};

inline bool is_specular(const Dielectric &lobe) {
    return lobe.alpha < kSmoothAlpha;
}
/// Reflectance of the micronormal at which wo has this cosine; eta as in bsdf/sample.h.
inline float reflectance(const Dielectric &lobe, float cos_o, float eta) {
    if (!lobe.reflects)
        return cos_o * cos_o + (eta - 1) * (eta + 1) > 0 ? 0.0f : 1.0f;
    return lobe.schlick ? fresnel_dielectric_schlick(cos_o, eta) : fresnel_dielectric(cos_o, eta);
}
/// At normal incidence.
inline Rgb albedo(const Dielectric &lobe) {
    const float r = reflectance(lobe, 1, lobe.ior);
    return lobe.reflection * (lobe.reflects ? r : 0) + lobe.transmission * (1 - r);
}
/// What it transmits has no bound that would hold for all indices around it.
inline float max_value(const Dielectric &) {
    return kInfinity;
}

/// The direction on the other side that wo is refracted to by a normal h with wo.h > 0; nothing in total reflection.
/// The cosine beyond is taken in the form that neither eta near 1 nor grazing incidence can spoil.
inline std::optional<Vec3f> refract(const Vec3f &wo, const Vec3f &h, float eta) {
    const float cos_o = dot(wo, h), inside = cos_o * cos_o + (eta - 1) * (eta + 1);
    if (!(inside > 0))
        return std::nullopt;
    return h * ((cos_o - std::sqrt(inside)) / eta) - wo * (1 / eta);
}

/// The micronormal, on the side of wo, that refracts wo to wi on the other side; nothing if there is none.
inline std::optional<Vec3f> refraction_normal(const Vec3f &wo, const Vec3f &wi, float eta) {
    Vec3f h = wo + wi * eta;
    const float size = length(h);
    if (!(size > 0))
        return std::nullopt;
    h = h / (h.z > 0 ? size : -size);
    if (!(dot(wo, h) > 0) || !(dot(wi, h) < 0))
        return std::nullopt;
    return h;
}

/// D G2 / (4 cos_o cos_i) times what is left of the factors: for both sides.
inline float ggx_masking_across(const Vec3f &wo, const Vec3f &wi, float alpha, Masking masking = Masking::Smith) {
    const float a_i = ggx_projected(wi, alpha), a_o = ggx_projected(wo, alpha), z_i = std::abs(wi.z);
    if (masking == Masking::SmithSeparable)
        return 4 * wo.z * z_i / ((z_i + a_i) * (wo.z + a_o));
    return 2 * wo.z * z_i / (z_i * a_o + wo.z * a_i);
}

/// f |cos_i| and the density of wi under sample().
struct DielectricValue {
    Rgb f;
    float pdf = 0;
};
[[gnu::noinline]] inline DielectricValue rough_dielectric(const Dielectric &lobe, const Vec3f &wo, const Vec3f &wi,
                                                          float eta) {
    const float visible = 2 / (wo.z + ggx_projected(wo, lobe.alpha)); // D_v(h) = visible D(h) (wo.h)
    if (wi.z > 0) {
        const Vec3f h = half_vector(wo, wi);
        const float r = reflectance(lobe, std::min(1.0f, dot(wo, h)), eta), d = ggx_d(h, lobe.alpha);
        if (!lobe.reflects)
            return {};
        return {lobe.reflection * (r * d * ggx_visibility(wo, wi, lobe.alpha, lobe.masking) * wi.z),
                r * visible * d / 4};
    }
    if (!(wi.z < 0) || eta == 1)
        return {};
    const auto h = refraction_normal(wo, wi, eta);
    if (!h)
        return {};
    const float cos_o = std::min(1.0f, dot(wo, *h)), cos_i = std::min(1.0f, -dot(wi, *h));
    const float t = 1 - reflectance(lobe, cos_o, eta), d = ggx_d(*h, lobe.alpha);
    const float across = cos_o - eta * cos_i;
    const float jacobian = eta * eta * cos_i / (across * across); // of h by wi
    if (!(t > 0) || !(jacobian < kInfinity))
        return {};
    return {lobe.transmission *
                (t * d * ggx_masking_across(wo, wi, lobe.alpha, lobe.masking) * cos_o * jacobian / wo.z),
            t * visible * d * cos_o * jacobian};
}

/// Of the light that facets send on to each other most is transmitted in the end: it has that colour, as in Cycles.
inline Rgb multiple_scattering_scale(const Dielectric &lobe, const Vec3f &wo, float eta) {
    return multiple_scattering_scale(ggx_dielectric_albedo(wo.z, lobe.alpha, eta),
                                     mean_ggx_dielectric_albedo(lobe.alpha, eta), lobe.transmission);
}

inline Rgb eval(const Dielectric &lobe, const Vec3f &wo, const Vec3f &wi, float eta) {
    if (is_specular(lobe))
        return {};
    const Rgb once = rough_dielectric(lobe, wo, wi, eta).f;
    return lobe.multiple_scattering ? once * multiple_scattering_scale(lobe, wo, eta) : once;
}
inline float pdf(const Dielectric &lobe, const Vec3f &wo, const Vec3f &wi, float eta) {
    return is_specular(lobe) ? 0 : rough_dielectric(lobe, wo, wi, eta).pdf;
}

/// A micronormal by the density of those that wo sees, all of them (Dupuy and Benyoub 2023): the bounded sampling of
/// sample_ggx_normal leaves out normals that reflect below the surface, but refract all the same.
inline Vec3f sample_visible_normal(const Vec3f &wo, float alpha, Vec2f u) {
    const Vec3f wo_std = normalize(Vec3f{wo.x * alpha, wo.y * alpha, wo.z});
    const float one_minus_z = u.y * (1 + wo_std.z), z = 1 - one_minus_z;
    const Vec2f p = circle_point(std::sqrt(std::max(0.0f, one_minus_z * (2 - one_minus_z))), u.x);
    return normalize(Vec3f{alpha * (p.x + wo_std.x), alpha * (p.y + wo_std.y), std::max(1e-30f, z + wo_std.z)});
}

[[gnu::noinline]] inline std::optional<BsdfSample> sample_rough_dielectric(const Dielectric &lobe, const Vec3f &wo,
                                                                           Vec2f u, float eta, float u_choice) {
    const Vec3f h = sample_visible_normal(wo, lobe.alpha, u);
    const float cos_o = std::min(1.0f, dot(wo, h)), r = reflectance(lobe, cos_o, eta);
    if (!(cos_o > 0))
        return std::nullopt;
    const bool transmitted = u_choice >= r;
    Vec3f wi;
    if (!transmitted) {
        wi = reflect(wo, h);
        if (!(wi.z > 0) || !lobe.reflects)
            return std::nullopt;
    } else {
        const auto beyond = refract(wo, h, eta);
        if (!beyond || !(beyond->z < 0))
            return std::nullopt;
        wi = normalize(*beyond);
        if (eta == 1) // nothing is bent: straight through, whatever the normal
            return BsdfSample{-wo, lobe.transmission, 1 - r, true, true};
    }
    // Weights are of the normal that was drawn: G2 / G1, whatever rounding makes of the normal between wo and wi.
    const float visible = 2 / (wo.z + ggx_projected(wo, lobe.alpha)), d = ggx_d(h, lobe.alpha);
    if (!transmitted)
        return BsdfSample{wi, lobe.reflection * (4 * ggx_visibility(wo, wi, lobe.alpha, lobe.masking) * wi.z / visible),
                          r * visible * d / 4, false, false};
    const float cos_i = -dot(wi, h), across = cos_o - eta * cos_i;
    const float density = (1 - r) * visible * d * cos_o * eta * eta * cos_i / (across * across);
    if (!(density > 0) || !(density < kInfinity))
        return std::nullopt;
    return BsdfSample{wi, lobe.transmission * (ggx_masking_across(wo, wi, lobe.alpha, lobe.masking) / (wo.z * visible)),
                      density, false, true};
}

/// Reflection or refraction, chosen by the reflectance. u_choice: the number that chooses.
inline std::optional<BsdfSample> sample(const Dielectric &lobe, const Vec3f &wo, Vec2f u, float eta, float u_choice) {
    if (!is_specular(lobe)) {
        auto s = sample_rough_dielectric(lobe, wo, u, eta, u_choice);
        if (s && lobe.multiple_scattering)
            s->weight *= multiple_scattering_scale(lobe, wo, eta);
        return s;
    }
    const float r = reflectance(lobe, wo.z, eta);
    if (u_choice < r) {
        if (!lobe.reflects)
            return std::nullopt;
        return BsdfSample{{-wo.x, -wo.y, wo.z}, lobe.reflection, r, true, false};
    }
    // cos_t = sqrt(1 - sin_i^2 / eta^2) in the form that neither eta near 1 nor grazing incidence can spoil.
    const float cos_t = std::sqrt(std::max(0.0f, wo.z * wo.z + (eta - 1) * (eta + 1))) / eta;
    return BsdfSample{{-wo.x / eta, -wo.y / eta, -cos_t}, lobe.transmission, 1 - r, true, true};
}

} // namespace glimmer
