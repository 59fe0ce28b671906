// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/return_bound.h"

namespace glimmer {

float return_bound(const Scene &scene, const Vec3f &x) {
    if (!scene.medium || !scene.medium->scatters() || scene.bounds_radius == 0)
        return 1;
    return scene.medium->return_probability(scene.bounds_radius, length(x - scene.bounds_center));
}

} // namespace glimmer
