// SPDX-License-Identifier: GPL-3.0-or-later
// The GGX (Trowbridge-Reitz) microfacet distribution, its masking functions and its sampling by visible normals.
#pragma once

#include "math/vec.h"
#include "sampling/warp.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace glimmer {

/// Below this a rough surface is treated as smooth.
inline constexpr float kSmoothAlpha = 1e-4f;

enum class Masking { Smith, SmithSeparable, SchlickGgx };

/// Density of normals, per solid angle of h (unit). c^2 (alpha^2 - 1) + 1 is 3.4 % off at alpha 1e-3 and divides by 0
/// at 1e-4 in float; alpha^2 c^2 + s^2 with s^2 = h_x^2 + h_y^2 is not.
inline float ggx_d(const Vec3f &h, float alpha) {
    const float a2 = alpha * alpha;
    const float q = a2 * h.z * h.z + (h.x * h.x + h.y * h.y);
    return a2 / (kPi * q * q);
}

/// cos_theta (1 + 2 Lambda) = sqrt(alpha^2 sin^2 + cos^2).
inline float ggx_projected(const Vec3f &w, float alpha) {
    return std::sqrt(alpha * alpha * (w.x * w.x + w.y * w.y) + w.z * w.z);
}

/// G / (4 cos_i cos_o): no division by a cosine, so grazing directions stay finite. (Heitz 2014; SchlickGgx is the
/// student report's with k = alpha / 2.)
inline float ggx_visibility(const Vec3f &wo, const Vec3f &wi, float alpha, Masking masking) {
    if (masking == Masking::SchlickGgx) {
        const float k = alpha / 2;
        return 1 / (4 * (wi.z * (1 - k) + k) * (wo.z * (1 - k) + k));
    }
    const float a_i = ggx_projected(wi, alpha), a_o = ggx_projected(wo, alpha);
    if (masking == Masking::SmithSeparable)
        return 1 / ((wi.z + a_i) * (wo.z + a_o));
    return 1 / (2 * (wi.z * a_o + wo.z * a_i));
}

/// k of Eto and Tokuyoshi 2023 ("Bounded VNDF Sampling for Smith-GGX Reflections", equation 5): how much of the lower
/// cap to leave out, since reflecting there ends below the surface.
inline float ggx_bound(const Vec3f &wo, float alpha) {
    const float a2 = alpha * alpha;
    const float s = 1 + std::sqrt(wo.x * wo.x + wo.y * wo.y), s2 = s * s;
    return (1 - a2) * s2 / (s2 + a2 * wo.z * wo.z);
}

/// A micronormal for the bounded sampling of visible normals, by spherical caps (Dupuy and Benyoub 2023). Reflecting wo
/// about it gives a direction with density ggx_reflection_pdf, which may still lie below the surface.
inline Vec3f sample_ggx_normal(const Vec3f &wo, float alpha, Vec2f u) {
    const Vec3f wo_std = normalize(Vec3f{wo.x * alpha, wo.y * alpha, wo.z});
    const float b = ggx_bound(wo, alpha) * wo_std.z;
    const float one_minus_z = u.y * (1 + b), z = 1 - one_minus_z; // z in (-b, 1]
    const Vec2f p = circle_point(std::sqrt(std::max(0.0f, one_minus_z * (2 - one_minus_z))), u.x);
    return normalize(Vec3f{alpha * (p.x + wo_std.x), alpha * (p.y + wo_std.y), std::max(1e-30f, z + wo_std.z)});
}

/// Density per solid angle of the direction wi that comes of reflecting wo about h, for h from sample_ggx_normal
/// (equation 8).
inline float ggx_reflection_pdf(const Vec3f &wo, const Vec3f &h, float alpha) {
    return ggx_d(h, alpha) / (2 * (ggx_bound(wo, alpha) * wo.z + ggx_projected(wo, alpha)));
}

inline Vec3f reflect(const Vec3f &wo, const Vec3f &h) {
    return h * (2 * dot(wo, h)) - wo;
}

/// The normal between two directions on the upper side.
inline Vec3f half_vector(const Vec3f &wo, const Vec3f &wi) {
    return normalize(wo + wi);
}

} // namespace glimmer
