// SPDX-License-Identifier: GPL-3.0-or-later
// What sampling the directions towards a light's shape returns.
//
// Shapes are given relative to the point they are seen from, in float64: a shape of the scene minus a position. pdf
// functions take the direction and answer 0 when it misses the shape; they say nothing about what stands in between.
#pragma once

#include "math/vec.h"

#include <cmath>
#include <optional>

namespace glimmer {

struct DirectionSample {
    Vec3f wi;       ///< unit, from the point towards the light
    float distance; ///< to the light's surface along wi; infinite for the sun
    float pdf;      ///< per solid angle
};

/// distance^2 / (|cos| area): the density per solid angle of a uniform choice by area.
inline double pdf_area_to_solid_angle(double distance_squared, double cos_theta, double area) {
    return distance_squared / (std::abs(cos_theta) * area);
}

/// The sample for a point chosen uniformly by area on a flat shape with unit normal n; nothing when the point looks
/// along the plane.
inline std::optional<DirectionSample> direction_to_area_point(const Vec3d &to_point, const Vec3d &n, double area) {
    const double distance_squared = length_squared(to_point), distance = std::sqrt(distance_squared);
    if (!(distance > 0))
        return std::nullopt;
    const double cos_theta = std::abs(dot(to_point, n)) / distance;
    const double pdf = pdf_area_to_solid_angle(distance_squared, cos_theta, area);
    if (!(pdf < 1e30)) // also 1/0; float ends at 3e38
        return std::nullopt;
    return DirectionSample{Vec3f(to_point / distance), static_cast<float>(distance), static_cast<float>(pdf)};
}

/// The point where a direction meets a plane through `on_plane`; nothing when it points away or runs along it.
inline std::optional<Vec3d> meet_plane(const Vec3f &wi, const Vec3d &on_plane, const Vec3d &n) {
    const Vec3d w(wi);
    const double t = dot(on_plane, n) / dot(w, n);
    if (!(t > 0) || !std::isfinite(t))
        return std::nullopt;
    return w * t;
}

} // namespace glimmer
