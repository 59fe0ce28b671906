// SPDX-License-Identifier: GPL-3.0-or-later
// Light on its straight way between two points, for every estimator that joins two. Medium::transmittance says what the
// medium leaves of it, before a ray is traced for it; visibility says what of that arrives.
#pragma once

#include "integrator/surface_transmittance.h"

namespace glimmer {

/// The part of what the transmittance of a ray promises that arrives at its end (t_max): none where an opaque surface
/// stands in the way, what the others let straight through else. bvh: false where all of the scene is a few spheres.
template <bool bvh = true>
Rgb visibility(const Scene &scene, const Ray &ray, RayKind kind, TraceContext &rays, uint32_t ignored_sphere = kNone) {
    ++rays.rays;
    const bool hidden =
        bvh ? scene.accel->occluded(ray, kind, ignored_sphere) : scene.accel->occluded_by_few(ray, ignored_sphere);
    if (!hidden)
        return Rgb(1);
    return scene.has_transparency ? surface_transmittance(scene, ray, kind, ignored_sphere, rays) : Rgb(0);
}

} // namespace glimmer
