// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/surface_transmittance.h"

namespace glimmer {

Rgb surface_transmittance(const Scene &scene, Ray ray, RayKind kind, uint32_t ignored_sphere, TraceContext &rays) {
    thread_local ClosureArena arena; // apart from the caller's, whose closures must last
    Rgb left(1);
    while (ray.t_max > 0) {
        ++rays.rays;
        const auto hit = scene.accel->intersect(ray, kind);
        if (!hit || (hit->instance == kNone && hit->primitive == ignored_sphere))
            break;
        Interaction surface = scene.interaction(ray, *hit);
        arena.clear();
        const Shading shading = scene.materials.shade(surface, {-ray.direction, 0, ray.time, kFromShadow}, arena);
        if (is_black(shading.transparency))
            return {};
        left *= shading.transparency;
        ray.origin = surface.origin_towards(ray.direction);
        ray.t_max -= hit->t;
    }
    return left;
}

} // namespace glimmer
