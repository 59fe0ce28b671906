// SPDX-License-Identifier: GPL-3.0-or-later
// What sampling a BSDF returns, and the conventions all of bsdf/ keeps.
//
// Directions are in the local frame, unit length, and point away from the surface; z is the shading normal on the side
// of wo, so cos_o = wo.z > 0 (the caller sees to it). eval is f |cos_i| and pdf is per solid angle of wi; both are 0
// for wi below the surface and for specular lobes, whose sample is the only way in. A sample that would leave below the
// surface is std::nullopt: it carries nothing, and stays in the count.
#pragma once

#include "math/vec.h"

namespace glimmer {

struct BsdfSample {
    Vec3f wi;
    Rgb weight;    ///< f |cos_i| / pdf
    float pdf;     ///< per solid angle; the probability of the choice when specular
    bool specular; ///< from a delta distribution
};

} // namespace glimmer
