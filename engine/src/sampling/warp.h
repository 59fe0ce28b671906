// SPDX-License-Identifier: GPL-3.0-or-later
// Maps of the unit square to simple domains, each with its density beside it.
#pragma once

#include "math/vec.h"

#include <algorithm>
#include <cmath>

namespace glimmer {

/// A point on the circle of radius r at the fraction u of its turn.
inline Vec2f circle_point(float r, float u) {
    const float phi = 2 * kPi * u;
    return {r * std::cos(phi), r * std::sin(phi)};
}

inline Vec3f sample_uniform_sphere(Vec2f u) {
    const Vec2f p = circle_point(2 * std::sqrt(u.x * (1 - u.x)), u.y);
    return {p.x, p.y, 1 - 2 * u.x};
}
inline float pdf_uniform_sphere() {
    return 1 / (4 * kPi);
}

/// The unit disk; keeps areas and, nearly, shapes (Shirley and Chiu 1997).
inline Vec2f sample_uniform_disk(Vec2f u) {
    const float x = 2 * u.x - 1, y = 2 * u.y - 1;
    if (x == 0 && y == 0)
        return {0, 0};
    const bool wide = std::abs(x) > std::abs(y);
    const float r = wide ? x : y;
    const float phi = wide ? (kPi / 4) * (y / x) : kPi / 2 - (kPi / 4) * (x / y);
    return {r * std::cos(phi), r * std::sin(phi)};
}
/// Per area.
inline float pdf_uniform_disk() {
    return 1 / kPi;
}

/// About +z; the cosine is 0 only where rounding says so.
inline Vec3f sample_cosine_hemisphere(Vec2f u) {
    const Vec2f d = sample_uniform_disk(u);
    return {d.x, d.y, std::sqrt(std::max(0.0f, 1 - (d.x * d.x + d.y * d.y)))};
}
inline float pdf_cosine_hemisphere(float cos_theta) {
    return std::max(0.0f, cos_theta) * (1 / kPi);
}

/// 1 - cos of the half angle under which a sphere of radius/distance s = R/d appears, 0 <= s <= 1. 1 - sqrt(1 - s^2) is
/// 7 % off at s = 1e-3 in float and 0 at 1e-4.
template <class T>
T one_minus_cos_of_sine(T s) {
    return s * s / (1 + std::sqrt(std::max(T(0), (1 - s) * (1 + s))));
}

/// The cone about +z; one_minus_cos_max in (0, 2]. u.x = 0 is the axis.
inline Vec3f sample_uniform_cone(float one_minus_cos_max, Vec2f u) {
    const float one_minus_cos = u.x * one_minus_cos_max;
    const Vec2f p = circle_point(std::sqrt(one_minus_cos * (2 - one_minus_cos)), u.y);
    return {p.x, p.y, 1 - one_minus_cos};
}
inline float pdf_uniform_cone(float one_minus_cos_max) {
    return 1 / (2 * kPi * one_minus_cos_max);
}

struct Barycentrics {
    float b0, b1, b2;
};
/// Uniform over a triangle with little distortion (Heitz 2019).
inline Barycentrics sample_triangle_barycentrics(Vec2f u) {
    float b0 = u.x / 2, b1 = u.y / 2;
    if (u.y > u.x) {
        b1 = u.y - b0;
    } else {
        b0 = u.x - b1;
    }
    return {b0, b1, std::max(0.0f, 1 - b0 - b1)};
}
/// Per unit of (b0, b1); per area it is 1/area.
inline float pdf_triangle_barycentrics() {
    return 2;
}

} // namespace glimmer
