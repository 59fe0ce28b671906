// SPDX-License-Identifier: GPL-3.0-or-later
// A perspective camera, pinhole or thin lens. Its image plane is at distance 1, so half_width is the tangent of half
// the horizontal angle.
#pragma once

#include "camera/from_point.h"

#include <cmath>
#include <optional>
#include <vector>

namespace glimmer {

struct PerspectiveCamera : CameraBase {
    CameraRay generate(Vec2f film, Vec2f lens, ShutterTime time) const {
        const Vec2f image = image_point(film);
        const Vec3f pinhole = forward + right * image.x + up * image.y; // 1 along the axis
        Vec3f origin, along = pinhole;
        if (has_lens()) {
            origin = lens_point(lens);
            along = pinhole - origin / focus_distance;
        }
        const float inv_cosine = length(along);
        Vec3f direction = along / inv_cosine;
        if (stereo.offset != 0)
            stereo.apply(origin, direction, {0, 0, 1});
        origin += direction * (clip_start * inv_cosine);
        return {{origin, direction, time, (clip_end - clip_start) * inv_cosine}, 0, 0};
    }

    std::optional<Projection> project(const Vec3f &x, Vec2f lens) const {
        const Vec3f from = lens_point(lens), way = x - from;
        const float along = depth(way), distance = length(way);
        if (!(along > clip_start && along < clip_end))
            return std::nullopt;
        Vec3f pinhole = way / along;
        if (has_lens())
            pinhole += from / focus_distance;
        const float cosine = along / distance, hidden = clip_start / cosine;
        const Vec3f direction = way / distance;
        return Projection{film_point({dot(pinhole, right), dot(pinhole, up)}),
                          from + direction * hidden,
                          direction,
                          distance - hidden,
                          distance * distance,
                          4 * half_width * half_width * aspect * cosine * cosine * cosine};
    }

    RayInterval clip(const Ray &ray, const FilmRectangle &film) const {
        RayInterval seen{0, ray.t_max};
        clip_to_side(seen, ray, forward, clip_start);
        if (has_lens()) // sees beyond the edges of what its middle sees
            return seen;
        const Vec2f first = image_point(film.begin), last = image_point(film.end); // y falls
        clip_to_side(seen, ray, right - forward * first.x, 0);
        clip_to_side(seen, ray, forward * last.x - right, 0);
        clip_to_side(seen, ray, forward * first.y - up, 0);
        clip_to_side(seen, ray, up - forward * last.y, 0);
        return seen;
    }

    PointOnRay sample_seen(const Ray &ray, const RayInterval &seen, float, float u) const {
        return sample_by_angle(ray, seen, u);
    }

    /// middle: unit direction; reach: radians.
    std::optional<Silhouette> silhouette(const Vec3f &center, float radius, float margin) const {
        return cone_about_sphere(*this, center, radius, margin);
    }

    bool sees_any(const std::vector<Silhouette> &silhouettes, Vec2f film) const {
        const Vec3f direction = generate(film, {}, {}).ray.direction;
        return std::any_of(silhouettes.begin(), silhouettes.end(), [&](const Silhouette &s) {
            return std::atan2(length(cross(direction, s.middle)), dot(direction, s.middle)) <= s.reach;
        });
    }

    float distance(const Vec3f &x) const { return length(x); }
    float footprint(float t) const { return t; }

    StartRegion start_region() const {
        const float x = (1 + 2 * std::abs(shift.x)) * half_width, y = (aspect + 2 * std::abs(shift.y)) * half_width;
        const float lean = has_lens() ? lens_radius / focus_distance : 0;
        return {Vec3f(), lens_radius + std::abs(stereo.offset) + clip_start * (std::sqrt(1 + x * x + y * y) + lean)};
    }
};

} // namespace glimmer
