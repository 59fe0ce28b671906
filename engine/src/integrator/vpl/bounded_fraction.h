// SPDX-License-Identifier: GPL-3.0-or-later
// How much of what a surface throws at a point of the medium comes from light vertices; paths bring the rest.
#pragma once

#include "bsdf/bsdf.h"

#include <algorithm>

namespace glimmer {

/// Connections are bounded: of f cos_o no more than this comes from them. A diffuse surface never reaches it
/// (albedo / pi); the narrow lobes of smooth metal do, and would throw all of a vertex's power at the few points that
/// they happen to aim at.
inline constexpr float kBsdfBound = 1;

/// min(1, kBsdfBound / (f cos_o)): a continuous function of the two directions alone, the same for light vertices and
/// paths, whose shares are this and what is left. f_cos_i: eval(bsdf, wo, wi); the cosines are the frame's.
inline float bounded_fraction(const Rgb &f_cos_i, float cos_o, float cos_i) {
    const float f_cos_o = max_component(f_cos_i) * cos_o / cos_i;
    return f_cos_o > kBsdfBound ? kBsdfBound / f_cos_o : 1.0f;
}

/// wo, wi: in the frame of the shading normal.
inline float bounded_fraction(Bsdf bsdf, const Vec3f &wo, const Vec3f &wi) {
    return bounded_fraction(eval(bsdf, wo, wi), wo.z, wi.z);
}

/// Whether vertices on the surface stand for all of its light.
inline bool is_bounded(float max_value) {
    return max_value <= kBsdfBound;
}

} // namespace glimmer
