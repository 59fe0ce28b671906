// SPDX-License-Identifier: GPL-3.0-or-later
// Multiple importance sampling (Veach and Guibas 1995).
#pragma once

namespace glimmer {

/// The balance heuristic's weight of technique a against technique b, given their densities. Written as
/// 1 / (1 + b/a), so that either density alone may be infinite or 0 without the weight becoming NaN.
inline float balance(float a, float b) {
    if (b == 0)
        return 1;
    return 1 / (1 + b / a);
}

/// Cycles' weight, the power heuristic's, for scenes in which the two techniques do not find the same light, so that
/// the weights are a part of what the picture shows (Scene::techniques_differ).
inline float cycles_weight(float a, float b) {
    if (b == 0)
        return 1;
    const float ratio = b / a;
    return 1 / (1 + ratio * ratio);
}

} // namespace glimmer
