// SPDX-License-Identifier: GPL-3.0-or-later
// Rough reflection whose facets lean further one way than the other: brushed metal, by GGX with two widths (Burley
// 2012; Heitz 2014, "Understanding the masking-shadowing function in microfacet-based BRDFs").
#pragma once

#include "bsdf/conductor.h"

#include <cmath>
#include <optional>

namespace glimmer {

struct Brushed {
    Conductor metal;                ///< its alpha is the geometric mean of both widths
    float alpha_x = 0, alpha_y = 0; ///< along the tangent and across it; at least kSmoothAlpha
    Vec3f tangent;                  ///< in the world; any where it is 0
    float rotation = 0;             ///< of the tangent about the normal, in turns
    Vec2f along{1, 0};              ///< unit: the tangent in the local frame (see set_frame)
};

/// To be called where the surface is shaded, before the lobe is used.
inline void set_frame(Brushed &lobe, const Frame &frame) {
    const Vec3f t = frame.to_local(lobe.tangent);
    const float size = std::sqrt(t.x * t.x + t.y * t.y);
    const Vec2f along = size > 1e-6f ? Vec2f{t.x / size, t.y / size} : Vec2f{1, 0};
    const Vec2f turned = circle_point(1, lobe.rotation);
    lobe.along = {along.x * turned.x - along.y * turned.y, along.y * turned.x + along.x * turned.y};
}

namespace brushed {

inline Vec3f to_tangent(const Brushed &lobe, const Vec3f &w) {
    return {lobe.along.x * w.x + lobe.along.y * w.y, lobe.along.x * w.y - lobe.along.y * w.x, w.z};
}
inline Vec3f from_tangent(const Brushed &lobe, const Vec3f &w) {
    return {lobe.along.x * w.x - lobe.along.y * w.y, lobe.along.y * w.x + lobe.along.x * w.y, w.z};
}
/// Density of normals per solid angle.
inline float d(const Brushed &lobe, const Vec3f &h) {
    const float x = h.x / lobe.alpha_x, y = h.y / lobe.alpha_y, q = x * x + y * y + h.z * h.z;
    return 1 / (kPi * lobe.alpha_x * lobe.alpha_y * q * q);
}
/// cos (1 + 2 Lambda).
inline float projected(const Brushed &lobe, const Vec3f &w) {
    const float x = lobe.alpha_x * w.x, y = lobe.alpha_y * w.y;
    return std::sqrt(x * x + y * y + w.z * w.z);
}
/// G / (4 cos_i cos_o).
inline float visibility(const Brushed &lobe, const Vec3f &wo, const Vec3f &wi) {
    const float a_i = projected(lobe, wi), a_o = projected(lobe, wo);
    return lobe.metal.masking == Masking::SmithSeparable ? 1 / ((wi.z + a_i) * (wo.z + a_o))
                                                         : 1 / (2 * (wi.z * a_o + wo.z * a_i));
}
/// The density of a direction over D of the normal that reflects it, for normals drawn as wo sees them.
inline float pdf_over_d(const Brushed &lobe, const Vec3f &wo) {
    return 0.5f / (wo.z + projected(lobe, wo));
}

} // namespace brushed

inline Rgb eval(const Brushed &lobe, const Vec3f &wo, const Vec3f &wi) {
    if (!(wi.z > 0))
        return {};
    const Vec3f o = brushed::to_tangent(lobe, wo), i = brushed::to_tangent(lobe, wi), h = half_vector(o, i);
    return facet_reflectance(lobe.metal, wo, std::min(1.0f, dot(o, h))) *
           (brushed::d(lobe, h) * brushed::visibility(lobe, o, i) * wi.z);
}
inline float pdf(const Brushed &lobe, const Vec3f &wo, const Vec3f &wi) {
    if (!(wi.z > 0))
        return 0;
    const Vec3f o = brushed::to_tangent(lobe, wo);
    return brushed::d(lobe, half_vector(o, brushed::to_tangent(lobe, wi))) * brushed::pdf_over_d(lobe, o);
}
/// By visible normals (Dupuy and Benyoub 2023).
inline std::optional<BsdfSample> sample(const Brushed &lobe, const Vec3f &wo, Vec2f u) {
    const Vec3f o = brushed::to_tangent(lobe, wo);
    const Vec3f o_std = normalize(Vec3f{o.x * lobe.alpha_x, o.y * lobe.alpha_y, o.z});
    const float one_minus_z = u.y * (1 + o_std.z), z = 1 - one_minus_z;
    const Vec2f p = circle_point(std::sqrt(std::max(0.0f, one_minus_z * (2 - one_minus_z))), u.x);
    const Vec3f h =
        normalize(Vec3f{lobe.alpha_x * (p.x + o_std.x), lobe.alpha_y * (p.y + o_std.y), std::max(1e-30f, z + o_std.z)});
    const Vec3f i = reflect(o, h);
    if (!(i.z > 0))
        return std::nullopt;
    const float over_d = brushed::pdf_over_d(lobe, o);
    return BsdfSample{brushed::from_tangent(lobe, i),
                      facet_reflectance(lobe.metal, wo, std::min(1.0f, dot(o, h))) *
                          (brushed::visibility(lobe, o, i) * i.z / over_d),
                      brushed::d(lobe, h) * over_d, false};
}
inline bool is_specular(const Brushed &) {
    return false;
}
inline Rgb albedo(const Brushed &lobe) {
    return albedo(lobe.metal);
}
inline Rgb coverage(const Brushed &lobe, const Vec3f &wo) {
    return coverage(lobe.metal, wo);
}
/// No f cos_o of any channel is larger (see Conductor).
inline float max_value(const Brushed &lobe) {
    const float once = 1 / (2 * kPi * lobe.alpha_x * lobe.alpha_y * std::min(lobe.alpha_x, lobe.alpha_y));
    return lobe.metal.multiple_scattering ? once * max_multiple_scattering_scale(lobe.metal.alpha) : once;
}

} // namespace glimmer
