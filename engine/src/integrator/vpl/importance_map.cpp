// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/vpl/importance_map.h"

#include "integrator/vpl/connect_simd.h"
#include "integrator/vpl/tuning.h"

#include <cmath>

namespace glimmer {

ImportanceMap::ImportanceMap(const Scene &scene, const std::vector<Vec3f> &gather_points) {
    if (!scene.medium)
        return;
    const float majorant = scene.medium->majorant();
    softening2_ = tuning::kImportanceSoftening2 / (majorant * majorant);
    kappa_ = scene.medium->effective_attenuation();
    const size_t n = (gather_points.size() + kSimdLanes - 1) / kSimdLanes * kSimdLanes;
    for (size_t i = 0; i < n; ++i) {
        const Vec3f &q = gather_points[i % gather_points.size()];
        x_.push_back(q.x), y_.push_back(q.y), z_.push_back(q.z);
    }
}

float ImportanceMap::operator()(const Vec3f &x) const {
    // The first summand keeps quotients of importances finite where all terms underflow.
    const float sum = 1e-30f + connect_kernels().diffuse({x_.data(), y_.data(), z_.data()}, x_.size(), x.x, x.y, x.z,
                                                         kappa_, softening2_);
    return std::sqrt(sum * std::sqrt(sum));
}

} // namespace glimmer
