// SPDX-License-Identifier: GPL-3.0-or-later
// Distances along a ray in proportion to the inverse square of the distance to a point (Kulla and Fajardo 2012).
#pragma once

#include "math/vec.h"

#include <algorithm>
#include <cmath>

namespace glimmer {

/// The part of a ray from offset a to offset b (a < b, b possibly infinite) from the point nearest to a light's centre,
/// h away from it. For a light of radius R pass h = sqrt(h^2 + R^2/4). pdf(t) = h / ((h^2 + t^2) angle).
class Equiangular {
  public:
    Equiangular(float a, float b, float h) : a_(a), b_(b) {
        // h = 0 has no angle; far below float's resolution of a and b it makes no difference.
        const float reach = std::max(std::abs(a), std::isinf(b) ? 0.0f : std::abs(b));
        h_ = std::max(h, std::max(1e-9f * reach, 1e-18f));
        // atan(b/h) - atan(a/h) is 4.6 % off at h = 1e-4 and 0 at 1e-6 in float.
        angle_ = std::isinf(b) ? std::atan2(h_, a) : std::atan2(h_ * (b - a), h_ * h_ + a * b);
    }

    /// u in [0, 1). Measured from whichever end of the full turn is nearer: tan(theta) near pi/2 has no digits left,
    /// and changes sign.
    float sample(float u) const {
        const float from_start = std::atan2(h_, -a_) + u * angle_;    // from the direction to t = -infinity
        const float from_end = std::atan2(h_, b_) + (1 - u) * angle_; // from the direction to t = +infinity
        const float t = from_start < from_end ? -h_ / std::tan(from_start) : h_ / std::tan(from_end);
        return std::clamp(t, a_, b_);
    }

    /// Per length; 0 outside the segment and for an empty one.
    float pdf(float t) const {
        if (!(t >= a_ && t <= b_) || !(angle_ > 0))
            return 0;
        return h_ / ((h_ * h_ + t * t) * angle_);
    }

  private:
    float a_, b_, h_, angle_;
};

inline float sample_equiangular(float a, float b, float h, float u) {
    return Equiangular(a, b, h).sample(u);
}
inline float pdf_equiangular(float a, float b, float h, float t) {
    return Equiangular(a, b, h).pdf(t);
}

} // namespace glimmer
