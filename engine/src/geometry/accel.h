// SPDX-License-Identifier: GPL-3.0-or-later
// What rays meet: mesh instances (two levels in Embree) and analytic spheres in one top-level BVH.
#pragma once

#include "geometry/mesh.h"
#include "geometry/ray.h"
#include "geometry/sphere.h"
#include "math/affine.h"

#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

namespace glimmer {

/// A mesh placed in the world. `linear` and `translation` carry mesh-centred vertices to the scene's origin.
struct Instance {
    const Mesh *mesh;
    std::array<Vec3f, 3> linear; ///< rows
    Vec3f translation;
    std::array<Vec3f, 3> normal_matrix; ///< rows; cofactors of the linear part, scaled: carries outward normals
    uint32_t object;                    ///< of the scene: holds the materials
    uint32_t object_index;              ///< for the AOV
    uint32_t motion = kNone;            ///< of Accel::motions(); kNone: still
    RayMask visible = kEveryRay;
    bool holdout = false;        ///< the camera sees nothing there, and nothing behind it
    float shadow_terminator = 0; ///< integrator/shadow_terminator.h

    Vec3f normal_to_world(const Vec3f &n) const {
        return Vec3f(dot(normal_matrix[0], n), dot(normal_matrix[1], n), dot(normal_matrix[2], n));
    }
    Vec3f to_world(const Vec3f &v) const {
        return Vec3f(dot(linear[0], v), dot(linear[1], v), dot(linear[2], v)) + translation;
    }
    /// How far from the scene's origin a ray may start for Embree to carry it into the mesh's own space; 0 when it
    /// cannot be carried there at all, so flat or so tiny is the instance, or so far away.
    float reach() const;
    /// Where it stands: matrices by the affine map of the mesh's own coordinates about its centre. False where it would
    /// be so flat that reach() is 0.
    bool place(const Linear &linear_map, const Vec3d &center);
};

/// An instance that moves: where it stands at moments evenly spaced from when the shutter opens to when it closes.
/// Between them its matrix is interpolated, as Embree does.
using InstanceMotion = std::vector<Instance>;

Instance interpolate(const InstanceMotion &motion, ShutterTime time);
/// Whether it has a volume all the way: linear interpolation of a turn of half a circle has none in its middle.
bool is_solid(const InstanceMotion &motion);
/// Whether a BVH whose instances can be reached from so far away takes the ray.
inline bool starts_within(const Ray &ray, float reach) { // written so that NaN fails
    const Vec3f &o = ray.origin, &d = ray.direction;
    return std::abs(o.x) <= reach && std::abs(o.y) <= reach && std::abs(o.z) <= reach && std::abs(d.x) <= 2 &&
           std::abs(d.y) <= 2 && std::abs(d.z) <= 2 && !std::isnan(ray.t_max);
}

class Accel {
  public:
    /// Builds at once, on `threads` threads at most (0: all). Spheres are about the scene's origin. Meshes must outlive
    /// this.
    /// visible: of each sphere; empty: all are to all rays.
    Accel(std::vector<Instance> instances, std::vector<InstanceMotion> motions, std::vector<Sphere> spheres,
          std::vector<RayMask> visible, uint32_t threads);
    Accel(const Accel &) = delete;
    Accel &operator=(const Accel &) = delete;

    /// A ray that is not finite, or starts beyond what every instance can be reached from, meets nothing.
    std::optional<Hit> intersect(const Ray &ray, RayKind kind) const;
    /// Whether anything stands before t_max. `ignored_sphere` is looked through (the light a shadow ray aims at).
    bool occluded(const Ray &ray, RayKind kind, uint32_t ignored_sphere = kNone) const;

    /// intersect() and occluded() where without_bvh(), without a call.
    std::optional<Hit> intersect_few(const Ray &ray) const {
        return can_trace(ray) ? nearest_sphere(ray) : std::nullopt;
    }
    bool occluded_by_few(const Ray &ray, uint32_t ignored_sphere) const {
        return can_trace(ray) && behind_sphere(ray, ignored_sphere);
    }

    /// Nothing but a handful of spheres: trying them one by one is faster than a BVH and gives the same bits.
    bool without_bvh() const { return instances_.empty() && spheres_.size() <= kFewSpheres && !hides_; }
    /// Whether something is hidden from some rays.
    bool hides() const { return hides_; }
    /// Of all but the meshes.
    size_t bytes() const;
    /// Those that move stand where they do when the shutter opens.
    const std::vector<Instance> &instances() const { return instances_; }
    const std::vector<InstanceMotion> &motions() const { return motions_; }
    const std::vector<Sphere> &spheres() const { return spheres_; }
    Instance instance_at(uint32_t index, ShutterTime time) const {
        const Instance &opening = instances_[index];
        return opening.motion == kNone ? opening : interpolate(motions_[opening.motion], time);
    }
    /// The BVH of an instance's mesh alone, in the mesh's coordinates about its centre.
    RTCScene mesh_bvh(uint32_t instance) const { return mesh_bvhs_[instance]; }
    RayMask visible_sphere(uint32_t i) const { return visible_.empty() ? kEveryRay : visible_[i]; }

  private:
    bool can_trace(const Ray &ray) const { return starts_within(ray, reach_); }
    std::optional<Hit> nearest_sphere(Ray ray) const {
        std::optional<Hit> hit;
        const Vec3d origin(ray.origin), direction(ray.direction);
        for (uint32_t i = 0; i < spheres_.size(); ++i)
            if (const auto t = first_root(spheres_[i], origin, direction, double(ray.t_max))) {
                ray.t_max = *t;
                hit = Hit{*t, kNone, i, 0, 0};
            }
        return hit;
    }
    bool behind_sphere(const Ray &ray, uint32_t ignored_sphere) const {
        const Vec3d origin(ray.origin), direction(ray.direction);
        for (uint32_t i = 0; i < spheres_.size(); ++i)
            if (i != ignored_sphere && first_root(spheres_[i], origin, direction, double(ray.t_max)))
                return true;
        return false;
    }

    static constexpr size_t kFewSpheres = 8;

    Bvh build(const std::vector<Bvh> &meshes, RayKind kind);
    RTCScene scene(RayKind kind) const { return scenes_[size_t(kind)]; }

    std::vector<Instance> instances_;
    std::vector<InstanceMotion> motions_;
    std::vector<Sphere> spheres_;
    std::vector<RayMask> visible_; ///< of the spheres; empty: all are to all rays
    bool hides_ = false;
    float reach_;
    std::shared_ptr<const EmbreeDevice> device_;
    std::vector<RTCScene> mesh_bvhs_;          ///< by instance; kept by the BVHs over them
    std::vector<Bvh> bvhs_;                    ///< one for all kinds of rays that see the same
    std::array<RTCScene, kRayKinds> scenes_{}; ///< theirs, by kind of ray
    size_t bvh_bytes_ = 0;
};

} // namespace glimmer
