// SPDX-License-Identifier: GPL-3.0-or-later
// Directions towards a triangle, uniform by area.
#pragma once

#include "light/shapes/direction_sample.h"
#include "sampling/warp.h"

#include <optional>

namespace glimmer {

/// a, b, c: corners minus the point. Nothing for a degenerate triangle or a point in its plane.
inline std::optional<DirectionSample> sample_triangle(const Vec3d &a, const Vec3d &b, const Vec3d &c, Vec2f u) {
    const Vec3d normal = cross(b - a, c - a);
    const double twice_area = length(normal);
    if (!(twice_area > 0))
        return std::nullopt;
    const Barycentrics w = sample_triangle_barycentrics(u);
    const Vec3d point = a + (b - a) * static_cast<double>(w.b1) + (c - a) * static_cast<double>(w.b2);
    return direction_to_area_point(point, normal / twice_area, twice_area / 2);
}

inline float pdf_triangle(const Vec3d &a, const Vec3d &b, const Vec3d &c, const Vec3f &wi) {
    const Vec3d normal = cross(b - a, c - a);
    const double twice_area = length(normal);
    if (!(twice_area > 0))
        return 0;
    const std::optional<Vec3d> p = meet_plane(wi, a, normal / twice_area);
    if (!p)
        return 0;
    const double w0 = dot(cross(b - *p, c - *p), normal), w1 = dot(cross(c - *p, a - *p), normal),
                 w2 = dot(cross(a - *p, b - *p), normal);
    if (w0 < 0 || w1 < 0 || w2 < 0)
        return 0;
    const double d2 = length_squared(*p), cosine = dot(*p, normal) / (std::sqrt(d2) * twice_area);
    return static_cast<float>(pdf_area_to_solid_angle(d2, cosine, twice_area / 2));
}

} // namespace glimmer
