// SPDX-License-Identifier: GPL-3.0-or-later
// Which normal a surface is shaded about: for a path from the camera, and for light that goes the other way.
#pragma once

#include "math/vec.h"

#include <algorithm>
#include <cmath>

namespace glimmer {

/// Whether light that leaves along wo is shaded about the shading normal; about the true one where wo is beneath the
/// shading normal's horizon, though not beneath the surface. Light paths choose by the direction that they take, not by
/// the one they come from: the camera path on the same way meets the surface from there. shading: on the side of wo.
inline bool is_above_horizon(const Vec3f &shading, const Vec3f &wo) {
    return dot(wo, shading) > 1e-6f;
}

/// What flux is scaled by where a mirror or glass, shaded about n, sends it from wi towards wo (both away from the
/// surface), beside what radiance is on the way back less its 1/eta^2: |wi.n| / |wi.ng| * |wo.ng| / |wo.n| (Veach 1997,
/// 5.3). wo as it was sampled in the frame of n has wo_n = wo.n.
inline float scale_of_flux(const Vec3f &n, const Vec3f &geometric, const Vec3f &wi, const Vec3f &wo, float wo_n) {
    return std::abs((dot(wi, n) / dot(wi, geometric)) * (dot(wo, geometric) / std::max(wo_n, 1e-7f)));
}

} // namespace glimmer
