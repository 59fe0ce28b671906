// SPDX-License-Identifier: GPL-3.0-or-later
// The Henyey-Greenstein phase function.
#pragma once

#include "math/vec.h"
#include "sampling/warp.h"

#include <cmath>

namespace glimmer {

struct PhaseSample {
    Vec3f direction; ///< of propagation after scattering
    float pdf;       ///< per solid angle; equals the phase function, so the weight is 1
};

inline constexpr float kIsotropicPhase = 1 / (4 * kPi);

/// g in (-1, 1) is the mean cosine between the directions of propagation before and after: g > 0 scatters forward.
/// (Toward the camera, wi = -direction of the light; mind the sign.) Its density is the phase function itself.
struct HenyeyGreenstein {
    float g = 0;

    /// From the cosine between the directions of propagation.
    float eval(float cos_theta) const { return from_tail(g < 0 ? 1 + cos_theta : 1 - cos_theta); }

    /// From the unit directions of propagation themselves: exact where 1 - cos would have cancelled, which decides at
    /// |g| > 0.99.
    float eval(const Vec3f &before, const Vec3f &after) const {
        return from_tail(length_squared(g < 0 ? before + after : before - after) / 2);
    }

    /// The largest value.
    float peak() const { return from_tail(0); }

    /// Both 1 - cos and 1 + cos by inversion without cancellation: the textbook form divides by g and subtracts.
    PhaseSample sample(const Vec3f &before, Vec2f u) const {
        if (g == 0)
            return {sample_uniform_sphere(u), kIsotropicPhase};
        const float h = std::abs(g), narrow = 1 - h, wide = 1 + h;
        const float q = narrow + 2 * h * u.x;
        const float one_minus_cos = 2 * narrow * narrow * (1 - u.x) * (1 + h * u.x) / (q * q);
        const float one_plus_cos = 2 * wide * wide * u.x * (narrow + h * u.x) / (q * q);
        const Vec2f p = circle_point(std::sqrt(one_minus_cos * one_plus_cos), u.y);
        const float cos_theta = one_minus_cos < 1 ? 1 - one_minus_cos : one_plus_cos - 1;
        const Vec3f local{p.x, p.y, g < 0 ? -cos_theta : cos_theta};
        const float both = narrow * wide;
        return {normalize(Frame(before).to_world(local)), q * q * q / (4 * kPi * both * both)};
    }

  private:
    /// tail: 1 - cos from the direction of the peak.
    float from_tail(float tail) const {
        const float h = std::abs(g), narrow = 1 - h;
        const float d2 = narrow * narrow + 2 * h * tail;
        return narrow * (1 + h) / (4 * kPi * d2 * std::sqrt(d2));
    }
};

} // namespace glimmer
