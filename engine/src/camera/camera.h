// SPDX-License-Identifier: GPL-3.0-or-later
// A perspective camera, pinhole or thin lens. The scene's origin is where it stands, so its rays start near 0.
#pragma once

#include "geometry/ray.h"
#include "math/vec.h"

#include <cmath>
#include <cstdint>
#include <optional>

namespace glimmer {

struct CameraRay {
    Ray ray;                   ///< t_max: the far clipping plane along this ray
    uint32_t pixel_x, pixel_y; ///< of the whole picture
};

/// A point as the camera sees it.
struct Projection {
    Vec2f film;             ///< as for Camera::generate; may lie outside 0 to 1
    Vec3f start, direction; ///< of the ray to it
    float distance, t;      ///< of the point from the lens, and from `start`
    float solid_angle;      ///< seen from the lens, of the whole film were it all as this place is
};

struct Camera {
    Vec3f right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1}; ///< orthonormal
    float tan_half_x = 1;                                 ///< tangent of half the horizontal angle
    float aspect = 1;                                     ///< height / width
    Vec2f shift;                                          ///< in widths
    float lens_radius = 0, focus_distance = 0;            ///< lengths
    float clip_start = 0, clip_end = kInfinity;           ///< lengths along the axis

    /// No ray starts further from the origin.
    float farthest_start() const {
        const float x = (1 + 2 * std::abs(shift.x)) * tan_half_x, y = (aspect + 2 * std::abs(shift.y)) * tan_half_x;
        const float lean = lens_radius > 0 ? lens_radius / focus_distance : 0;
        return lens_radius + clip_start * (std::sqrt(1 + x * x + y * y) + lean);
    }

    /// The ray through a point of the film (x right, y down, both 0 to 1) and a point of the lens (unit disk).
    CameraRay generate(Vec2f film, Vec2f lens) const {
        const float sx = (2 * film.x - 1 + 2 * shift.x) * tan_half_x;
        const float sy = ((1 - 2 * film.y) * aspect + 2 * shift.y) * tan_half_x;
        const Vec3f pinhole = forward + right * sx + up * sy; // 1 along the axis
        Vec3f origin, along = pinhole;
        if (lens_radius > 0) {
            origin = (right * lens.x + up * lens.y) * lens_radius;
            along = pinhole - origin / focus_distance;
        }
        const float inv_cosine = length(along);
        const Vec3f direction = along / inv_cosine;
        origin += direction * (clip_start * inv_cosine);
        return {{origin, direction, (clip_end - clip_start) * inv_cosine}, 0, 0};
    }

    /// The inverse: where a point is seen from a point of the lens (unit disk); nothing behind the clipping planes.
    std::optional<Projection> project(const Vec3f &x, Vec2f lens) const {
        const Vec3f from = (right * lens.x + up * lens.y) * lens_radius, way = x - from;
        const float depth = dot(way, forward), distance = length(way);
        if (!(depth > clip_start && depth < clip_end))
            return std::nullopt;
        Vec3f pinhole = way / depth;
        if (lens_radius > 0)
            pinhole += from / focus_distance;
        const float sx = dot(pinhole, right) / tan_half_x, sy = dot(pinhole, up) / tan_half_x;
        const Vec2f film{(sx + 1) / 2 - shift.x, (1 - (sy - 2 * shift.y) / aspect) / 2};
        const float cosine = depth / distance, hidden = clip_start / cosine;
        const Vec3f direction = way / distance;
        return Projection{
            film,     from + direction * hidden, direction,
            distance, distance - hidden,         4 * tan_half_x * tan_half_x * aspect * cosine * cosine * cosine};
    }
};

} // namespace glimmer
