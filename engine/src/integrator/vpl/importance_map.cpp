// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/vpl/importance_map.h"

#include "integrator/vpl/tuning.h"

#include <cmath>

namespace glimmer {

ImportanceMap::ImportanceMap(const Scene &scene, std::vector<Vec3f> gather_points) : points_(std::move(gather_points)) {
    if (!scene.medium)
        return;
    const float majorant = scene.medium->majorant();
    softening2_ = tuning::kImportanceSoftening2 / (majorant * majorant);
    kappa_ = scene.medium->effective_attenuation();
}

float ImportanceMap::operator()(const Vec3f &x) const {
    float sum = 1e-30f; // keeps quotients of importances finite where all terms underflow
    for (const Vec3f &q : points_) {
        const float d2 = length_squared(x - q);
        sum += std::exp(-kappa_ * std::sqrt(d2)) / std::sqrt(d2 + softening2_);
    }
    return std::sqrt(sum * std::sqrt(sum));
}

} // namespace glimmer
