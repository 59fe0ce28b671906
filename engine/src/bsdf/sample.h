// SPDX-License-Identifier: GPL-3.0-or-later
// What sampling a BSDF returns, and the conventions all of bsdf/ keeps.
//
// Directions are in the local frame, unit length, and point away from the surface; z is the shading normal on the side
// of wo, so cos_o = wo.z > 0 (the caller sees to it). eval is f |cos_i| and pdf is per solid angle of wi; wi.z < 0 is
// light from the other side, which lobes that reflect alone know nothing of: both are 0 there, and for specular lobes,
// whose sample is the only way in. A sample that would leave on a side that the lobe does not know is std::nullopt: it
// carries nothing, and stays in the count.
//
// Some lobes are not reciprocal: what they keep of the light depends on wo alone. Then wo is the side of the camera, in
// eval and in the weights of samples; paths from lights see to that (adjoint_weight in bsdf/bsdf.h).
//
// At the boundary of a dielectric eta is the index of refraction on the other side over that on the side of wo. What is
// refracted keeps its radiance (docs/method.md, section 19): paths from the camera scale nothing, paths from lights
// what they refract by 1 / eta^2 (adjoint_weight).
#pragma once

#include "math/vec.h"

#include <cstdint>

namespace glimmer {

struct BsdfSample {
    Vec3f wi;
    Rgb weight;               ///< f |cos_i| / pdf
    float pdf;                ///< per solid angle; the probability of the choice when specular
    bool specular;            ///< from a delta distribution
    bool transmitted = false; ///< wi is on the other side
    bool diffuse = false;     ///< of a diffuse lobe; set for a whole Bsdf alone
    uint32_t lobe = 0;        ///< of the Bsdf: which one was drawn
};

} // namespace glimmer
