// SPDX-License-Identifier: GPL-3.0-or-later
// Rays that leave a light: where light subpaths start.
#pragma once

#include "light/interface.h"
#include "light/spot_cone.h"
#include "math/rounding.h"
#include "sampling/warp.h"

namespace glimmer {

/// A ray from a point of a surface, started off it by the rounding error; cosine-distributed unless its direction is
/// given. radiance(direction): of the surface there.
template <class Radiance>
Emission emit_from_surface(const Vec3f &position, const Vec3f &normal, float error, double area,
                           const EmissionDirection &to, const Radiance &radiance) {
    if (to.is_given()) {
        const float cosine = std::max(dot(to.direction, normal), 0.0f);
        return {{position + normal * error, to.direction, {}},
                radiance(to.direction) * (float(area) * cosine / to.pdf)};
    }
    const Vec3f direction = normalize(Frame(normal).to_world(sample_cosine_hemisphere(to.u)));
    return {{position + normal * error, direction, {}}, radiance(direction) * float(kPiDouble * area)};
}

struct WeightedDirection {
    Vec3f direction;
    float weight; ///< 1 over the density per solid angle, times the cone's falloff
};

/// Evenly over all directions, or those of a spot, unless it is given.
inline WeightedDirection emission_direction(const std::optional<SpotCone> &cone, const EmissionDirection &to) {
    if (to.is_given())
        return {to.direction, falloff(cone, to.direction) / to.pdf};
    if (!cone)
        return {sample_uniform_sphere(to.u), 4 * kPi};
    const float one_minus_cos = 1 - cone->cos_half;
    const Vec3f direction = normalize(Frame(cone->direction).to_world(sample_uniform_cone(one_minus_cos, to.u)));
    return {direction, cone->falloff(direction) * 2 * kPi * one_minus_cos};
}

} // namespace glimmer
