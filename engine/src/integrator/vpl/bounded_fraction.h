// SPDX-License-Identifier: GPL-3.0-or-later
// The bounded fraction of the BSDF (docs/method.md, section 5). The narrow lobes of smooth metal would throw all of a
// vertex's power at the few gather points that they happen to aim at. Connections therefore carry f cos(theta_o) only
// up to a bound; camera paths and splats carry the remainder.
#pragma once

#include "bsdf/bsdf.h"
#include "integrator/vpl/tuning.h"

#include <algorithm>

namespace glimmer {

/// min(1, bound / (f cos_o)), a continuous function of the two directions alone, so that light vertices, camera paths
/// and splats compute the same value for the same pair. f_cos_i: eval(bsdf, wo, wi). cos_o, cos_i: in the frame of that
/// evaluation, greater than 0.
inline float bounded_fraction(const Rgb &f_cos_i, float cos_o, float cos_i) {
    const float f_cos_o = max_component(f_cos_i) * cos_o / cos_i;
    return f_cos_o > tuning::kBsdfBound ? tuning::kBsdfBound / f_cos_o : 1.0f;
}

/// The same for wo and wi in the frame of the shading normal.
inline float bounded_fraction(const Bsdf &bsdf, const Vec3f &wo, const Vec3f &wi) {
    return bounded_fraction(eval(bsdf, wo, wi), wo.z, wi.z);
}

/// Whether connections carry all of the light of a surface whose f cos(theta_o) is at most `max_value`.
inline bool is_bounded(float max_value) {
    return max_value <= tuning::kBsdfBound;
}

} // namespace glimmer
