// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "math/constants.h"

#include <cstdint>

namespace glimmer {

/// The choice of one of n by weights of the sum `total`, mixed with the uniform choice: weights are guesses, and what
/// has next to none may bring light too. A sum that is no use (all is beyond many mean free paths, so that its
/// reciprocal is beyond float32, or there is a weight beyond it) guides nothing.
struct DefensiveMixture {
    float even, scale;

    /// uniform: the share of the uniform choice.
    DefensiveMixture(float total, uint32_t n, float uniform) {
        const bool guided = total > 1e-30f && total < kInfinity;
        even = (guided ? uniform : 1.0f) / float(n);
        scale = guided ? (1 - uniform) / total : 0.0f;
    }

    float probability(float weight) const { return even + scale * weight; }
};

} // namespace glimmer
