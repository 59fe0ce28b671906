// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/dielectrics_at.h"

#include <algorithm>
#include <vector>

namespace glimmer {

namespace {

constexpr int kMostSurfaces = 100000; // surfaces along the ray; ends the search should a ray not get away from one

} // namespace

InteriorStack dielectrics_at(const Scene &scene, const Vec3f &x, ShutterTime time, RayKind kind) {
    InteriorStack stack;
    if (!scene.has_dielectrics)
        return stack;
    struct Crossing { // out of a body that the ray had not entered, and that therefore holds x
        uint32_t body;
        float ior;
    };
    std::vector<Crossing> crossings;
    std::vector<uint32_t> entered;
    // An arbitrary direction, so that the ray does not run along walls or through edges of axis-aligned models.
    Ray ray{x, normalize(Vec3f(0.2672f, 0.5345f, 0.8018f)), time};
    for (int i = 0; i < kMostSurfaces; ++i) {
        const auto hit = scene.accel->intersect(ray, kind);
        if (!hit)
            break;
        const Interaction surface = scene.interaction(ray, *hit);
        const Material &material = scene.materials[surface.material];
        if (material.interior_ior > 0 && !scene.is_sheet(surface)) {
            if (dot(ray.direction, surface.geometric_normal) < 0)
                entered.push_back(surface.body);
            else if (auto it = std::find(entered.begin(), entered.end(), surface.body); it != entered.end())
                entered.erase(it);
            else
                crossings.push_back({surface.body, material.interior_ior});
        }
        ray.origin = surface.origin_towards(ray.direction);
    }
    for (size_t i = crossings.size(); i-- > 0;)
        stack.enter(crossings[i].body, crossings[i].ior, scene.within_glass());
    return stack;
}

} // namespace glimmer
