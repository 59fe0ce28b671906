// SPDX-License-Identifier: GPL-3.0-or-later
// A smooth boundary between dielectrics.
#pragma once

#include "bsdf/fresnel.h"
#include "math/vec.h"

#include <cmath>

namespace glimmer {

struct DielectricSample {
    Vec3f wi;
    Rgb weight;        ///< of radiance that arrives along wi
    float probability; ///< of this choice
    bool transmitted;
};

/// Reflection or refraction, chosen by its Fresnel reflectance. wo as in bsdf/sample.h; eta = n on the other side / n
/// on the side of wo, > 0. What is conserved along a refracted ray is radiance / n^2: what arrives from the other side
/// counts 1/eta^2 on this one. (Flux, or importance, would not be scaled.) schlick: Schlick's approximation in place of
/// the exact reflectance.
inline DielectricSample sample_dielectric(const Vec3f &wo, float eta, bool schlick, float u) {
    const float reflectance = schlick ? fresnel_dielectric_schlick(wo.z, eta) : fresnel_dielectric(wo.z, eta);
    if (u < reflectance)
        return {{-wo.x, -wo.y, wo.z}, Rgb(1), reflectance, false};
    // cos_t = sqrt(1 - sin_i^2 / eta^2) in the form that neither eta near 1 nor grazing incidence can spoil.
    const float cos_t = std::sqrt(std::max(0.0f, wo.z * wo.z + (eta - 1) * (eta + 1))) / eta;
    return {{-wo.x / eta, -wo.y / eta, -cos_t}, Rgb(1 / (eta * eta)), 1 - reflectance, true};
}

} // namespace glimmer
