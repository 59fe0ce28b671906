// SPDX-License-Identifier: GPL-3.0-or-later
// Media whose coefficients differ from place to place, as tracking asks for them.
#pragma once

#include "geometry/ray.h"
#include "math/vec.h"

namespace glimmer {

/// What a medium is at a point, per length.
struct MediumPoint {
    Rgb sigma_a, sigma_s, emission;
    float g = 0;

    Rgb sigma_t() const { return sigma_a + sigma_s; }
};

class VaryingCoefficients {
  public:
    virtual ~VaryingCoefficients() = default;

    /// Of a medium within a body of the boundaries; x is about the scene's origin. All numbers are finite, coefficients
    /// >= 0.
    virtual MediumPoint at(uint32_t medium, uint32_t body, const Vec3f &x, ShutterTime time) const = 0;
};

} // namespace glimmer
