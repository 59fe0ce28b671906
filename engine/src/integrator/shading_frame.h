// SPDX-License-Identifier: GPL-3.0-or-later
// Which normal a surface is shaded about, for paths from the camera and for light subpaths, which must agree.
#pragma once

#include "math/vec.h"

#include <algorithm>
#include <cmath>

namespace glimmer {

/// Whether light that leaves along wo is shaded about the shading normal. Where wo is below its horizon, though not
/// below the true surface, it is shaded about the true normal. Light subpaths decide by the direction that they leave
/// by, not by the one they come from, since a camera path along the same way arrives there. shading: on the side of wo.
inline bool is_above_horizon(const Vec3f &shading, const Vec3f &wo) {
    return dot(wo, shading) > 1e-6f;
}

/// The factor that flux has over radiance where a mirror or dielectric, shaded about n, sends it from wi towards wo
/// (both away from the surface): |wi.n| / |wi.ng| * |wo.ng| / |wo.n| (Veach 1997, section 5.3), without the 1/eta^2 of
/// radiance that is refracted. wo_n: wo.n as it was sampled in the frame of n.
inline float scale_of_flux(const Vec3f &n, const Vec3f &geometric, const Vec3f &wi, const Vec3f &wo, float wo_n) {
    return std::abs((dot(wi, n) / dot(wi, geometric)) * (dot(wo, geometric) / std::max(wo_n, 1e-7f)));
}

} // namespace glimmer
