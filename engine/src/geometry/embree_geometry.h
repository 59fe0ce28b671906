// SPDX-License-Identifier: GPL-3.0-or-later
// What all of our BVHs have in common: rays, instances and spheres as Embree takes them.
#pragma once

#include "geometry/accel.h"

namespace glimmer {

// Embree's own limit of a coordinate. Debian's build asserts it for every ray, also in an instance's space, and a
// failed assertion ends the whole process, Blender with it.
inline constexpr float kMostCoordinate = 1.844e18f;

inline RTCRay embree_ray(const Ray &ray) {
    RTCRay r{};
    r.org_x = ray.origin.x, r.org_y = ray.origin.y, r.org_z = ray.origin.z;
    r.dir_x = ray.direction.x, r.dir_y = ray.direction.y, r.dir_z = ray.direction.z;
    r.tnear = kNearestHit;
    r.tfar = ray.t_max;
    r.time = ray.time.value;
    r.mask = ~0u;
    return r;
}

/// Adds an instance of a mesh's scene as geometry `id`. motions: what Instance::motion means.
void attach_instance(const EmbreeDevice &device, RTCScene scene, RTCScene mesh, const Instance &instance,
                     const std::vector<InstanceMotion> &motions, unsigned id);

/// Adds spheres, which must stay where they are, as geometry `id`.
void attach_spheres(const EmbreeDevice &device, RTCScene scene, const std::vector<Sphere> &spheres, unsigned id,
                    RTCIntersectFunctionN intersect, RTCOccludedFunctionN occluded);

} // namespace glimmer
