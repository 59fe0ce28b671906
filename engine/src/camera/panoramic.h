// SPDX-License-Identifier: GPL-3.0-or-later
// A panoramic camera: its rays start at one point, or on a lens about it that faces every direction; panorama.h says
// which direction is seen where. Clipping planes are spheres about it, and what is in focus lies on one.
#pragma once

#include "camera/from_point.h"
#include "camera/panorama.h"

#include <cmath>
#include <optional>
#include <vector>

namespace glimmer {

struct PanoramicCamera : CameraBase {
    Panorama panorama;

    CameraRay generate(Vec2f film, Vec2f lens, ShutterTime time) const {
        const std::optional<Vec3f> seen = panorama.direction(film);
        if (!seen)
            return CameraRay::blind(forward, time);
        Vec3f origin, direction = to_world(*seen);
        if (has_lens()) {
            const Vec3f in_focus = direction * focus_distance;
            origin = lens_point(lens, direction);
            direction = normalize(in_focus - origin);
        }
        if (stereo.offset != 0)
            stereo.apply(origin, direction, up);
        origin += direction * clip_start;
        return {{origin, direction, time, clip_end - clip_start}, 0, 0};
    }

    /// With a lens, the rays through x are numbered by where they meet what is in focus: a cap about x, of which `lens`
    /// gives a point by its area. So `lens` is not the point of the lens that generate means.
    std::optional<Projection> project(const Vec3f &x, Vec2f lens) const {
        const float away = length(x);
        if (!(away > 0))
            return std::nullopt;
        Vec3f axis = x / away, start;
        float area = 1; // of the cap, over that of the lens as it is seen from x, times away^2
        if (has_lens() && std::abs(away / focus_distance - 1) > kInFocus) {
            const float cap = cap_height(away), sine = std::sqrt(cap * (2 - cap));
            axis = around(axis, lens, cap);
            const float along = dot(x, axis), left = 1 - along / focus_distance;
            start = (x - axis * along) * (1 / left);
            if (!(along > 0) || !is_on_lens(start, axis) || !(sine > 0))
                return std::nullopt;
            const float cosine = focus_distance / length(axis * focus_distance - start);
            area = lens_radius * lens_radius * aperture.area() * left * left * cosine / (2 * cap * away * away);
        }
        const Vec3f way = x - start;
        const float distance = length(way);
        if (!(distance > clip_start && distance < clip_end))
            return std::nullopt;
        const Vec3f local = to_camera(axis);
        const std::optional<Vec2f> film = panorama.film(local);
        const float solid_angle = panorama.solid_angle(local);
        if (!film || !(solid_angle > 0))
            return std::nullopt;
        const Vec3f direction = way / distance;
        return Projection{
            *film, start + direction * clip_start, direction, distance - clip_start, away * away * area, solid_angle};
    }

    template <class Function>
    void for_each_place(Vec2f film, const Function &function) const {
        panorama.for_each_place(film, function);
    }
    bool has_blind_places() const { return panorama.has_circle(); }
    bool is_invertible(Vec2f margin) const {
        return CameraBase::is_invertible(margin) && panorama.is_invertible(margin);
    }

    float depth(const Vec3f &x) const { return length(x); }

    RayInterval clip(const Ray &ray, const FilmRectangle &) const { return {0, ray.t_max}; }

    PointOnRay sample_seen(const Ray &ray, const RayInterval &seen, float, float u) const {
        return sample_by_angle(ray, seen, u);
    }

    /// middle: unit direction; reach: radians. half_width: half of Panorama::angle_per_width.
    std::optional<Silhouette> silhouette(const Vec3f &center, float radius, float margin) const {
        return cone_about_sphere(*this, center, radius, margin);
    }

    bool sees_any(const std::vector<Silhouette> &silhouettes, Vec2f film) const {
        const std::optional<Vec3f> seen = panorama.direction(film);
        if (!seen)
            return false;
        const Vec3f direction = to_world(*seen);
        return std::any_of(silhouettes.begin(), silhouettes.end(), [&](const Silhouette &s) {
            return std::atan2(length(cross(direction, s.middle)), dot(direction, s.middle)) <= s.reach;
        });
    }

    float distance(const Vec3f &x) const { return length(x); }
    float footprint(float t) const { return t; }
    StartRegion start_region() const { return {Vec3f(), lens_radius + std::abs(stereo.offset) + clip_start}; }

  private:
    /// Nearer to what is in focus than this part of its distance, all rays through a point are one.
    static constexpr float kInFocus = 1e-4f;

    Vec3f to_world(const Vec3f &d) const { return right * d.x + up * d.y + forward * d.z; }
    Vec3f to_camera(const Vec3f &d) const { return {dot(d, right), dot(d, up), dot(d, forward)}; }

    /// The lens faces `direction`; x leads to the axis, as in Cycles.
    Vec3f lens_axis(const Vec3f &direction) const {
        const Vec3f x = forward - direction * dot(forward, direction);
        return length_squared(x) > 1e-12f ? normalize(x) : up;
    }
    Vec3f lens_point(Vec2f disk, const Vec3f &direction) const {
        const Vec2f lens = aperture.point(disk);
        const Vec3f x = lens_axis(direction);
        return (x * lens.x + cross(direction, x) * lens.y) * lens_radius;
    }
    bool is_on_lens(const Vec3f &start, const Vec3f &direction) const {
        if (aperture.is_disk()) // whose rays are all that reach the cap; but for rounding
            return length_squared(start) <= lens_radius * lens_radius * (1 + 1e-4f);
        const Vec3f x = lens_axis(direction);
        return aperture.contains({dot(start, x) / lens_radius, dot(start, cross(direction, x)) / lens_radius});
    }

    /// 1 - cos of the angle about a point, `away` from the camera, within which rays through it meet what is in focus.
    float cap_height(float away) const {
        const float spread = std::atan(lens_radius / focus_distance);
        const float sine = std::sin(spread) * focus_distance / away;
        if (away <= lens_radius || !(sine < 1)) // within the lens: anywhere before it
            return 1;
        const float half = std::sin(0.5f * std::abs(std::asin(sine) - spread));
        return 2 * half * half;
    }

    /// By area within the cap about `axis`.
    static Vec3f around(const Vec3f &axis, Vec2f disk, float cap) {
        const float square = disk.x * disk.x + disk.y * disk.y, height = square * cap;
        const float scale = std::sqrt(cap * (2 - height));
        const Frame frame(axis);
        return normalize(frame.to_world({disk.x * scale, disk.y * scale, 1 - height}));
    }
};

} // namespace glimmer
