// SPDX-License-Identifier: GPL-3.0-or-later
// Ray-sphere intersection that holds from R/d = 1e-6 to cameras a metre above a planet.
#pragma once

#include "math/vec.h"

#include <limits>
#include <optional>

namespace glimmer {

struct Sphere {
    Vec3d center;
    double radius;
};

struct SphereRoots {
    double near, far;
};

/// Both parameters at which the line meets the sphere (Haines, Guenther, Akenine-Moeller: Precision Improvements for
/// Ray/Sphere Intersection, Ray Tracing Gems ch. 7), in float64: the textbook b^2 - 4ac in float32 misses a fifth of
/// the hits at d = 1e4 R.
inline std::optional<SphereRoots> intersect_sphere(const Sphere &sphere, const Vec3d &origin, const Vec3d &direction) {
    const Vec3d f = origin - sphere.center;
    const double a = dot(direction, direction);
    const double b = -dot(f, direction);
    const Vec3d closest = f + direction * (b / a);
    const double discriminant = sphere.radius * sphere.radius - dot(closest, closest);
    if (discriminant < 0)
        return std::nullopt;
    const double f_length = length(f);
    const double c = (f_length - sphere.radius) * (f_length + sphere.radius);
    const double q = b + std::copysign(std::sqrt(a * discriminant), b);
    if (q == 0) // at the centre of a sphere of radius 0, or tangent at the origin
        return SphereRoots{0, 0};
    const double t0 = c / q, t1 = q / a;
    return t0 < t1 ? SphereRoots{t0, t1} : SphereRoots{t1, t0};
}

/// Where rays begin to meet anything. Not 0: a camera on a surface is not within it.
inline constexpr float kNearestHit = std::numeric_limits<float>::min();

/// The first root between kNearestHit and t_max.
inline std::optional<float> first_root(const Sphere &sphere, const Vec3d &origin, const Vec3d &direction,
                                       double t_max) {
    const auto roots = intersect_sphere(sphere, origin, direction);
    if (!roots)
        return std::nullopt;
    if (roots->near > double(kNearestHit) && roots->near <= t_max)
        return float(roots->near);
    if (roots->far > double(kNearestHit) && roots->far <= t_max)
        return float(roots->far);
    return std::nullopt;
}

} // namespace glimmer
