// SPDX-License-Identifier: GPL-3.0-or-later
// A see-through disk of uniform radiance that faces whoever looks, or a spot of that kind: Blender's point lamps until
// 3.6, and its lamps of soft falloff since. At the distance d it looks as a cone of the half angle atan(r/d).
//
// No body of the world shines so. A straight line that passes the centre at the distance h < r is lit where it is
// farther than h^2/sqrt(r^2 - h^2) beyond the point nearest to the centre, and dark before; light that is traced from
// the lamp begins there. What stands between that nearest point and the receiver hides the light.
#pragma once

#include "light/emission.h"
#include "light/interface.h"
#include "light/shapes/direction_sample.h"
#include "light/shapes/sphere.h"
#include "light/spot_cone.h"
#include "sampling/warp.h"

#include <cmath>

namespace glimmer {

struct DiskLamp {
    Vec3d center;
    double radius;
    Rgb radiance;
    std::optional<SpotCone> cone;

    static constexpr LightTraits traits{.intersectable = true};

    /// Per solid angle, of directions to points that are uniform on the disk. cosine: to the direction to the centre.
    float density(double distance, double cosine) const {
        return float(distance * distance / (kPiDouble * radius * radius * cosine * cosine * cosine));
    }
};

inline std::optional<LightSample> sample(const DiskLamp &light, const Vec3f &x, Vec2f u) {
    const Vec3d to_center = light.center - Vec3d(x);
    const double distance = length(to_center);
    if (!(distance > 0))
        return std::nullopt;
    const Vec2f on = sample_uniform_disk(u);
    const double side_x = double(on.x) * light.radius, side_y = double(on.y) * light.radius;
    const double to_disk = std::sqrt(distance * distance + side_x * side_x + side_y * side_y);
    const double cosine = distance / to_disk;
    const Vec3f wi(about_axis(to_center / distance, side_x / to_disk, side_y / to_disk, cosine));
    const float factor = falloff(light.cone, -wi);
    if (factor == 0)
        return std::nullopt;
    return LightSample{wi, float(distance * cosine), light.radiance * factor, light.density(distance, cosine), false};
}

inline float pdf(const DiskLamp &light, const Vec3f &x, const Vec3f &direction, const LightHit &) {
    const Vec3d to_center = light.center - Vec3d(x);
    const double distance = length(to_center), cosine = dot(to_center, Vec3d(direction)) / distance;
    return cosine > 0 ? light.density(distance, cosine) : 0.0f;
}

inline std::optional<LampHit> intersect(const DiskLamp &light, const Ray &ray) {
    const Vec3d to_center = light.center - Vec3d(ray.origin), direction(ray.direction);
    const double nearest = dot(to_center, direction);
    if (!(nearest > 0 && nearest < double(ray.t_max)) ||
        length(cross(to_center, direction)) * length(to_center) > light.radius * nearest)
        return std::nullopt;
    const float factor = falloff(light.cone, -ray.direction);
    if (factor == 0)
        return std::nullopt;
    return LampHit{float(nearest), light.radiance * factor};
}

inline Emission emit(const DiskLamp &light, bool, Vec2f u_position, const EmissionDirection &to, float) {
    const auto [direction, weight] = emission_direction(light.cone, to);
    const Vec2f on = sample_uniform_disk(u_position);
    const double r = light.radius, side_x = double(on.x) * r, side_y = double(on.y) * r;
    const double h2 = side_x * side_x + side_y * side_y, dark = h2 / std::sqrt(r * r - h2);
    if (!(dark < 1e30)) // a line that touches the rim
        return {};
    const Vec3d axis(direction), nearest = light.center + about_axis(axis, side_x, side_y, 0);
    const double area = kPiDouble * r * r;
    return {{Vec3f(nearest + axis * dark), direction, {}}, light.radiance * (weight * float(area)), float(dark)};
}

inline LightBound bound(const DiskLamp &light) {
    const double r = light.radius;
    return {Vec3f(light.center), float(r), false, bounded_strength(light.radiance, kPiDouble * r * r)};
}

} // namespace glimmer
