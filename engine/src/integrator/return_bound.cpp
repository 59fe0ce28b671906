// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/return_bound.h"

#include <cmath>
#include <vector>

namespace glimmer {

float return_bound(const Scene &scene, const Vec3f &x) {
    if (!scene.medium || !scene.medium->scatters() || scene.bounds_radius == 0)
        return 1;
    const float r = length(x - scene.bounds_center);
    float most = 0; // of the channels: a path goes on in whichever carries it furthest
    for (int c = 0; c < 3; ++c) {
        const float sigma_t = scene.medium->sigma_t[c], sigma_s = scene.medium->sigma_s[c];
        if (!(sigma_s > 0))
            continue;
        const float reach = scene.bounds_radius + 1 / sigma_t;
        if (r <= reach)
            return 1;
        const float kappa = std::min(std::sqrt(3 * std::max(1 - sigma_s / sigma_t, 0.0f)), 1.0f) * sigma_t;
        const float ratio = reach / r;
        most = std::max(most, ratio * ratio * std::exp(-kappa * (r - reach)));
    }
    return most;
}

InteriorStack dielectrics_at(const Scene &scene, const Vec3f &x) {
    InteriorStack stack;
    if (!scene.has_dielectrics)
        return stack;
    struct Crossing { // out of a body that the ray had not entered
        uint32_t body;
        float ior;
    };
    std::vector<Crossing> crossings;
    std::vector<uint32_t> entered;
    // No axis of any scene, so that it does not run along walls or edges.
    Ray ray{x, normalize(Vec3f(0.2672f, 0.5345f, 0.8018f))};
    for (int i = 0; i < 100000; ++i) {
        const auto hit = scene.accel->intersect(ray);
        if (!hit)
            break;
        const Interaction surface = scene.interaction(ray, *hit);
        const Material &material = scene.materials[surface.material];
        if (material.kind == MaterialKind::glass) {
            if (dot(ray.direction, surface.geometric_normal) < 0)
                entered.push_back(surface.body);
            else if (auto it = std::find(entered.begin(), entered.end(), surface.body); it != entered.end())
                entered.erase(it);
            else
                crossings.push_back({surface.body, material.ior});
        }
        ray.origin = surface.origin_towards(ray.direction);
    }
    for (size_t i = crossings.size(); i-- > 0;)
        stack.enter(crossings[i].body, crossings[i].ior);
    return stack;
}

} // namespace glimmer
