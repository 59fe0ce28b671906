// SPDX-License-Identifier: GPL-3.0-or-later
// Directions towards a flat ellipse, uniform by area.
#pragma once

#include "light/shapes/direction_sample.h"
#include "sampling/warp.h"

#include <optional>

namespace glimmer {

/// Centre minus the point, and the two half axes (perpendicular to each other, not zero).
struct EllipseShape {
    Vec3d center, half_x, half_y;
};

inline std::optional<DirectionSample> sample_ellipse(const EllipseShape &e, Vec2f u) {
    const Vec2f d = sample_uniform_disk(u);
    const Vec3d normal = cross(e.half_x, e.half_y);
    const double product = length(normal); // of the half axes
    const Vec3d point = e.center + e.half_x * static_cast<double>(d.x) + e.half_y * static_cast<double>(d.y);
    return direction_to_area_point(point, normal / product, kPiDouble * product);
}

inline float pdf_ellipse(const EllipseShape &e, const Vec3f &wi) {
    const Vec3d normal = cross(e.half_x, e.half_y);
    const double product = length(normal);
    const std::optional<Vec3d> p = meet_plane(wi, e.center, normal / product);
    if (!p)
        return 0;
    const Vec3d offset = *p - e.center;
    const double x = dot(offset, e.half_x) / length_squared(e.half_x),
                 y = dot(offset, e.half_y) / length_squared(e.half_y);
    if (x * x + y * y > 1)
        return 0;
    const double d2 = length_squared(*p), cosine = dot(*p, normal) / (std::sqrt(d2) * product);
    return static_cast<float>(pdf_area_to_solid_angle(d2, cosine, kPiDouble * product));
}

} // namespace glimmer
