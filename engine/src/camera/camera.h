// SPDX-License-Identifier: GPL-3.0-or-later
// The camera: one of a closed set of kinds, each in a file of its own. The scene's origin is where it stands, so that
// rays start near 0; but only the kinds know that, and what they see from there. One that moves is, at each moment, a
// camera of its kind that stands elsewhere; the origin is where it stands in the middle.
#pragma once

#include "camera/camera_motion.h"
#include "camera/orthographic.h"
#include "camera/panoramic.h"
#include "camera/perspective.h"

#include <variant>

namespace glimmer {

class Camera {
    template <class Function>
    decltype(auto) visit(const Function &function) const {
        return std::visit(function, kind_);
    }

    /// Where a camera that keeps still stands: no sum, so that it costs nothing and changes no bit.
    struct Origin {};
    static Vec3f from(const Vec3f &x, Origin) { return x; }
    static Vec3f from(const Vec3f &x, const Vec3f &place) { return x - place; }
    static void move(Vec3f &, Origin) {}
    static void move(Vec3f &x, const Vec3f &place) { x += place; }
    template <class Place>
    static Ray from(Ray ray, const Place &place) {
        ray.origin = from(ray.origin, place);
        return ray;
    }

    /// function(the camera of a moment as if it stood at the origin, where it stands)
    template <class Function>
    auto at(ShutterTime time, const Function &function) const {
        return visit([&](const auto &c) {
            if (!moves())
                return function(c, Origin());
            const CameraPose pose = motion_.at(time);
            auto turned = c;
            turned.right = pose.right, turned.up = pose.up, turned.forward = pose.forward;
            return function(turned, pose.position);
        });
    }

  public:
    using Kind = std::variant<PerspectiveCamera, OrthographicCamera, PanoramicCamera>;

    Camera() = default;
    Camera(const PerspectiveCamera &camera) : kind_(camera) {}
    Camera(const OrthographicCamera &camera) : kind_(camera) {}
    Camera(const PanoramicCamera &camera) : kind_(camera) {}

    void set_motion(CameraMotion motion) { motion_ = std::move(motion); }
    bool moves() const { return !motion_.empty(); }

    /// The ray through a point of the film (x right, y down, both 0 to 1) and a point of the lens (unit disk); blind
    /// where nothing is seen there.
    CameraRay generate(Vec2f film, Vec2f lens, ShutterTime time) const {
        return at(time, [&](const auto &c, const auto &place) {
            CameraRay out = c.generate(film, lens, time);
            move(out.ray.origin, place);
            return out;
        });
    }

    /// The inverse: where a point is seen from a point of the lens; nothing behind the clipping planes. Of a lens:
    /// uniform points of the unit disk stand for all rays through the point. Panoramas may see it elsewhere too, see
    /// for_each_place.
    std::optional<Projection> project(const Vec3f &x, Vec2f lens, ShutterTime time) const {
        return at(time, [&](const auto &c, const auto &place) {
            std::optional<Projection> out = c.project(from(x, place), lens);
            if (out)
                move(out->start, place);
            return out;
        });
    }

    /// function(film) for every place of the film where what project has found at `film` is seen. False for
    /// is_invertible: these are not all. margin: what filters add to the film.
    template <class Function>
    void for_each_place(Vec2f film, const Function &function) const {
        visit([&](const auto &c) { c.for_each_place(film, function); });
    }
    bool is_invertible(Vec2f margin) const {
        return visit([&](const auto &c) { return c.is_invertible(margin); });
    }

    /// Whether generate's rays may be blind.
    bool has_blind_places() const {
        return visit([](const auto &c) { return c.has_blind_places(); });
    }

    /// Whether generate and project look at `lens` at all.
    bool has_lens() const {
        return visit([](const auto &c) { return c.has_lens(); });
    }

    /// The part of a ray outside which nothing is seen in this part of the film, whatever stands in the way; empty
    /// (begin >= end) where that is all of it. Without a lens, the smallest one.
    RayInterval clip(const Ray &ray, const FilmRectangle &film) const {
        return at(ray.time, [&](const auto &c, const auto &place) { return c.clip(from(ray, place), film); });
    }

    /// A point of the part `seen` (see clip) of a ray of light, drawn in proportion to what the film would receive from
    /// it, as nearly as is known. extinction: by length, of the medium that carries the light to the point and on.
    PointOnRay sample_seen(const Ray &ray, const RayInterval &seen, float extinction, float u) const {
        return at(ray.time, [&](const auto &c, const auto &place) {
            return c.sample_seen(from(ray, place), seen, extinction, u);
        });
    }

    /// Where a sphere is seen in the middle of a motion, and `margin` around it, a length on the film in units of half
    /// its width; none where the camera is within the sphere. No bound: of a wide lens the edge of the blur may lie
    /// outside.
    std::optional<Silhouette> silhouette(const Vec3f &center, float radius, float margin) const {
        return visit([&](const auto &c) { return c.silhouette(center, radius, margin); });
    }
    bool sees_any(const std::vector<Silhouette> &silhouettes, Vec2f film) const {
        return visit([&](const auto &c) { return c.sees_any(silhouettes, film); });
    }

    /// How far a point is from where rays start in the middle of a motion, but for the near plane and the lens: beyond
    /// the reach of what is seen this still grows.
    float distance(const Vec3f &x) const {
        return visit([&](const auto &c) { return c.distance(x); });
    }

    /// Along the axis; of a panoramic camera the distance.
    float depth(const Vec3f &x, ShutterTime time) const {
        return at(time, [&](const auto &c, const auto &place) { return c.depth(from(x, place)); });
    }

    /// How wide a fixed small part of the film is t from where a ray starts, in a unit of the camera's own.
    float footprint(float t) const {
        return visit([&](const auto &c) { return c.footprint(t); });
    }

    StartRegion start_region() const {
        const StartRegion still = visit([](const auto &c) { return c.start_region(); });
        if (!moves())
            return still;
        StartRegion all;
        for (const CameraPose &step : motion_.steps())
            all.radius = std::max(all.radius, length(step.position));
        all.radius += length(still.center) + still.radius;
        return all;
    }

  private:
    Kind kind_; ///< as it stands in the middle of a motion
    CameraMotion motion_;
};

} // namespace glimmer
