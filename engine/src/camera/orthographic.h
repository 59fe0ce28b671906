// SPDX-License-Identifier: GPL-3.0-or-later
// An orthographic camera: its rays are parallel to the axis, or with a lens go through points in focus that are. The
// image plane lies across the axis where the camera stands; rays start at the near plane, which may lie behind it.
#pragma once

#include "camera/camera_base.h"
#include "sampling/exponential.h"

#include <cmath>
#include <optional>
#include <vector>

namespace glimmer {

struct OrthographicCamera : CameraBase {
    CameraRay generate(Vec2f film, Vec2f lens, ShutterTime time) const {
        Vec3f origin = on_image_plane(image_point(film)), along = forward;
        if (has_lens()) {
            const Vec3f from = lens_point(lens);
            origin += from;
            along = along - from / focus_distance;
        }
        const float inv_cosine = length(along);
        const Vec3f direction = along / inv_cosine;
        return {{origin + along * clip_start, direction, time, (clip_end - clip_start) * inv_cosine}, 0, 0};
    }

    std::optional<Projection> project(const Vec3f &x, Vec2f lens) const {
        const float away = depth(x);
        if (!(away > clip_start && away < clip_end))
            return std::nullopt;
        Vec3f along = forward, in_focus = x;
        if (has_lens()) {
            const Vec3f from = lens_point(lens);
            along = along - from / focus_distance;
            in_focus = in_focus - from * (1 - away / focus_distance);
        }
        const float inv_cosine = length(along);
        const float area = 4 * half_width * half_width * aspect; // of the film, across the axis
        return Projection{film_point({dot(in_focus, right), dot(in_focus, up)}),
                          x - along * (away - clip_start),
                          along / inv_cosine,
                          (away - clip_start) * inv_cosine,
                          1,
                          area / inv_cosine};
    }

    RayInterval clip(const Ray &ray, const FilmRectangle &film) const {
        RayInterval seen{0, ray.t_max};
        clip_to_side(seen, ray, forward, clip_start);
        clip_to_side(seen, ray, -forward, -clip_end);
        if (has_lens()) // sees beyond the edges of what its middle sees
            return seen;
        const Vec2f first = image_point(film.begin), last = image_point(film.end); // y falls
        clip_to_side(seen, ray, right, first.x);
        clip_to_side(seen, ray, -right, -last.x);
        clip_to_side(seen, ray, -up, -first.y);
        clip_to_side(seen, ray, up, last.y);
        return seen;
    }

    /// No distance weakens what the film receives, only the medium on the way to the point and on: as
    /// e^(-extinction (1 + cos) t), where the angle is between the ray and the axis.
    PointOnRay sample_seen(const Ray &ray, const RayInterval &seen, float extinction, float u) const {
        const float all = seen.end - seen.begin, rate = extinction * (1 + dot(ray.direction, forward));
        if (rate * all < 1e-4f) // all but even
            return {seen.begin + u * all, 1 / all};
        const float scattered = one_minus_exp(rate * all), from_begin = -std::log1p(-u * scattered) / rate;
        return {std::min(seen.begin + from_begin, seen.end), rate * std::exp(-rate * from_begin) / scattered};
    }

    /// middle: on the plane across the axis through the camera; reach: length.
    std::optional<Silhouette> silhouette(const Vec3f &center, float radius, float margin) const {
        const float away = depth(center);
        const float blur = has_lens() ? lens_radius * std::abs(1 - away / focus_distance) : 0;
        return Silhouette{center - forward * away, radius + margin * half_width + blur};
    }

    bool sees_any(const std::vector<Silhouette> &silhouettes, Vec2f film) const {
        const Vec3f at = on_image_plane(image_point(film));
        return std::any_of(silhouettes.begin(), silhouettes.end(),
                           [&](const Silhouette &s) { return length_squared(at - s.middle) <= s.reach * s.reach; });
    }

    /// From the film, moved to the near plane.
    float distance(const Vec3f &x) const {
        const Vec3f way = x - middle_of_starts();
        return length(Vec3f(std::max(std::abs(dot(way, right)) - half_width, 0.0f),
                            std::max(std::abs(dot(way, up)) - half_width * aspect, 0.0f), depth(way)));
    }
    float footprint(float) const { return 1; }

    StartRegion start_region() const {
        const float lens = has_lens() ? lens_radius * std::abs(1 - clip_start / focus_distance) : 0;
        return {middle_of_starts(), half_width * std::sqrt(1 + aspect * aspect) + lens};
    }

  private:
    Vec3f on_image_plane(Vec2f image) const { return right * image.x + up * image.y; }
    Vec3f middle_of_starts() const { return on_image_plane(image_point({0.5f, 0.5f})) + forward * clip_start; }
};

} // namespace glimmer
