// SPDX-License-Identifier: GPL-3.0-or-later
// What cameras have in common whose rays leave the scene's origin, but for a lens.
#pragma once

#include "camera/camera_base.h"
#include "medium/equiangular.h"

#include <cmath>
#include <optional>

namespace glimmer {

/// By the angle about the camera, whose density takes the place of 1 / distance^2 in what the film receives.
inline PointOnRay sample_by_angle(const Ray &ray, const RayInterval &seen, float u) {
    const float foot = -dot(ray.origin, ray.direction); // of the perpendicular from the camera
    const Equiangular angle(seen.begin - foot, seen.end - foot, length(ray.origin + ray.direction * foot));
    const float from_foot = angle.sample(u);
    return {from_foot + foot, angle.pdf(from_foot)};
}

/// Unit direction and radians: the cone in which a sphere is seen, wider by `margin` half widths and by its blur.
/// Nothing where the camera is within it.
inline std::optional<Silhouette> cone_about_sphere(const CameraBase &camera, const Vec3f &center, float radius,
                                                   float margin) {
    const float away = length(center);
    if (!(radius < away))
        return std::nullopt;
    const float blur = camera.has_lens() ? camera.lens_radius * std::abs(1 / away - 1 / camera.focus_distance) : 0;
    return Silhouette{center / away, std::asin(radius / away) + margin * camera.half_width + blur};
}

} // namespace glimmer
