// SPDX-License-Identifier: GPL-3.0-or-later
// The surfaces that enclose media, apart from those that light meets: rays pass them, and ask which bodies they are in.
#pragma once

#include "geometry/accel.h"

#include <vector>

namespace glimmer {

/// Where a ray goes into a body or comes out of it.
struct Crossing {
    float t;
    uint32_t body;
    bool enters;
};

/// Where a body stands: from the scene's space to its own.
struct BodyFrame {
    std::array<Vec3f, 3> to_local{Vec3f{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}; ///< rows of the linear part
    Vec3f translation;                                                   ///< of its origin, in the scene

    Vec3f vector(const Vec3f &v) const { return {dot(to_local[0], v), dot(to_local[1], v), dot(to_local[2], v)}; }
    Vec3f point(const Vec3f &p) const { return vector(p - translation); }
};

/// What is on the inner side of all of its planes.
struct ConvexBody {
    struct Plane {
        Vec3f normal; ///< outward
        float offset; ///< of the plane from the origin, along the normal
    };
    std::vector<Plane> planes;

    /// The part of the whole line; empty where begin >= end.
    RayInterval clip(const Ray &ray) const;
};

/// Bodies are counted from 0: the instances, then the spheres.
class Boundaries {
  public:
    /// Builds at once, on `threads` threads at most (0: all). Meshes must outlive this.
    Boundaries(std::vector<Instance> instances, std::vector<InstanceMotion> motions, std::vector<Sphere> spheres,
               uint32_t threads);
    Boundaries(const Boundaries &) = delete;
    Boundaries &operator=(const Boundaries &) = delete;

    /// All crossings beyond the ray's origin, however far, in order. They alone say what a ray starts in: a body that
    /// it leaves once more than it enters. So no path needs to remember where it is, and a point next to a wall is on
    /// the side where the ray finds it. A ray that Accel could not trace meets nothing.
    void cross(const Ray &ray, std::vector<Crossing> &crossings) const;

    size_t size() const { return instances_.size() + spheres_.size(); }
    /// Where a body stands at a moment: an instance with its matrix; a sphere as a body of radius 1 about its centre.
    BodyFrame frame(uint32_t body, ShutterTime time) const;
    /// The instance of a body at a moment; nothing for a sphere.
    std::optional<Instance> instance(uint32_t body, ShutterTime time) const;
    /// Asked only of a sphere.
    const Sphere &sphere(uint32_t body) const { return spheres_[body - instances_.size()]; }
    /// A box about a body, in its own space.
    void local_bounds(uint32_t body, Vec3f &low, Vec3f &high) const;
    /// A sphere that holds all bodies.
    Sphere bounds() const;
    /// Whether there is a single body, still, closed, convex and with its normals outward: the way between two points
    /// in it is in it, too. False for a mesh of so many triangles that the test would take long.
    bool is_one_convex_body() const { return convex_; }
    size_t bytes() const;
    /// While the shutter is open.
    bool moves() const { return !motions_.empty(); }

  private:
    std::vector<Instance> instances_;
    std::vector<InstanceMotion> motions_;
    std::vector<Sphere> spheres_;
    float reach_;
    std::shared_ptr<const EmbreeDevice> device_;
    std::vector<Bvh> meshes_; ///< of the instances' meshes, each once
    Bvh bvh_;
    size_t bvh_bytes_ = 0;
    bool convex_ = false;
    ConvexBody polytope_; ///< where a single body has few faces: faster than a
                          ///< BVH; else without planes
};

} // namespace glimmer
