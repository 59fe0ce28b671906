// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/return_bound.h"

#include <algorithm>
#include <cmath>

namespace glimmer {

float return_bound(const Scene &scene, const Vec3f &x) {
    if (!scene.medium || !scene.medium->scatters() || scene.bounds_radius == 0)
        return 1;
    const float r = length(x - scene.bounds_center);
    float most = 0; // over the channels: the path may go on in whichever carries it furthest
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

} // namespace glimmer
