// SPDX-License-Identifier: GPL-3.0-or-later
// Directions towards a sphere, uniform in the cone it fills.
#pragma once

#include "light/shapes/direction_sample.h"
#include "sampling/warp.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace glimmer {

/// A unit direction at polar offset (x, y, z) about a unit axis, in float64 (frame of Duff et al. 2017): for a small
/// light the float32 frame's error is as large as the light.
inline Vec3d about_axis(const Vec3d &axis, double x, double y, double z) {
    const double sign = std::copysign(1.0, axis.z), a = -1 / (sign + axis.z), b = axis.x * axis.y * a;
    return Vec3d{1 + sign * axis.x * axis.x * a, sign * b, -sign * axis.x} * x +
           Vec3d{b, sign + axis.y * axis.y * a, -axis.y} * y + axis * z;
}

/// 1 - cos of the cone, or 2 (every direction) from within or on the sphere.
inline double sphere_one_minus_cos(double distance, double radius) {
    return distance > radius ? one_minus_cos_of_sine(radius / distance) : 2;
}

/// to_center: centre minus point; radius > 0. From within, the whole sphere of directions, and the distance is to the
/// far side. Otherwise uniform in the cone, and the distance is to the near side.
inline std::optional<DirectionSample> sample_sphere(const Vec3d &to_center, double radius, Vec2f u) {
    const double d2 = length_squared(to_center), d = std::sqrt(d2);
    const double omc = sphere_one_minus_cos(d, radius);
    const double ux = static_cast<double>(u.x), phi = 2 * kPiDouble * static_cast<double>(u.y);
    const double one_minus_cos = ux * omc, sine = std::sqrt(one_minus_cos * (2 - one_minus_cos));
    const double cosine = 1 - one_minus_cos;
    const Vec3d axis = d > 0 ? to_center / d : Vec3d{0, 0, 1};
    const Vec3d wi = about_axis(axis, sine * std::cos(phi), sine * std::sin(phi), cosine);
    const auto pdf = static_cast<float>(1 / (2 * kPiDouble * omc));
    double distance;
    if (d > radius) {
        // s^2 - sin^2 and d - R in forms that do not cancel: exact at the rim and close to the surface.
        const double root = std::sqrt((omc - one_minus_cos) * (2 - omc - one_minus_cos));
        distance = (d - radius) * (d + radius) / (d * (cosine + root));
    } else {
        // On the sphere itself, outward, the far side is the point: 0 but for rounding.
        distance = std::max(0.0, d * cosine + std::sqrt(std::max(0.0, radius * radius - d2 * sine * sine)));
    }
    return DirectionSample{Vec3f(wi), static_cast<float>(distance), pdf};
}

/// Density of sample_sphere for any direction that meets the sphere (the caller knows that it does).
inline float pdf_sphere(const Vec3d &to_center, double radius) {
    return static_cast<float>(1 / (2 * kPiDouble * sphere_one_minus_cos(length(to_center), radius)));
}

} // namespace glimmer
