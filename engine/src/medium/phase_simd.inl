// SPDX-License-Identifier: GPL-3.0-or-later
// The Henyey-Greenstein phase function on sixteen lanes; for the rules of this file see math/simd/instruction_set.h.
#pragma once

#include "math/simd/float16.h"

namespace glimmer {
namespace {

constexpr float kSimdIsotropicPhase = 0.0795774715f; // 1 / (4 pi), per solid angle

/// Of cosines between directions of propagation.
class SimdPhase {
  public:
    explicit SimdPhase(float g)
        : constant_(1 + g * g), slope_(2 * g), scale_((1 - g) * (1 + g) * kSimdIsotropicPhase) {}
    Float16 operator()(Float16 cosine) const {
        const Float16 d2 = max(constant_ - slope_ * cosine, Float16(1e-12f));
        return scale_ / (d2 * sqrt(d2));
    }

  private:
    Float16 constant_, slope_, scale_;
};

/// Of light that comes from one point, flies to the place s on a line, and is scattered back along the line. s is the
/// place's distance from the line's nearest point to the light, nearest2 the squared distance of that point. It
/// computes how far 1 - cos is from 0 at the peak without cancellation, which decides where |g| > 0.99.
inline Float16 phase_towards_line(float g, Float16 s, Float16 nearest2) {
    const float h = g < 0 ? -g : g, narrow = 1 - h;
    const Float16 zero, away = g < 0 ? zero - s : s, d = sqrt(max(nearest2 + s * s, Float16(1e-30f)));
    const Float16 far = d + max(away, zero - away); // d + |s|
    const Float16 tail =
        (zero_where_below(away, zero, far) + zero_where_below(zero - away, Float16(1e-37f), nearest2 / far)) / d;
    const Float16 d2 = Float16(narrow * narrow) + Float16(2 * h) * tail;
    return Float16(narrow * (1 + h) * kSimdIsotropicPhase) / (d2 * sqrt(d2));
}

} // namespace
} // namespace glimmer
