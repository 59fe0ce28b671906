// SPDX-License-Identifier: GPL-3.0-or-later
// Russian roulette (docs/method.md, section 10). A path survives with probability min(1, scale * weight), where weight
// is its throughput times a bound on what it can still bring. With a scale k above 1 no path ends before its weight has
// fallen below 1/k. Ending a path early saves little, because its camera ray, medium and direct light are already
// paid for; and where something bright was still to come, the few survivors are the brighter.
#pragma once

#include "base/tunable.h"

#include <cstdint>

namespace glimmer {

/// The scale at surfaces, and at segments between them whose medium is joined to light vertices. Measured:
/// `build.py bench --tuning kRouletteScaleAtSurfaces`.
GLIMMER_TUNABLE_CONSTANT(float, kRouletteScaleAtSurfaces, 3);

/// The scale at gather points that the camera sees directly, and along their compensation rays. Measured:
/// `build.py bench --tuning kRouletteScaleAtGathers`.
GLIMMER_TUNABLE_CONSTANT(float, kRouletteScaleAtGathers, 8);

/// The scale where paths walk through the medium without light vertices. Measured: `build.py bench --tuning
/// kRouletteScaleInMedium`. With a larger one, paths in a thick medium of high albedo grow longer by a hundred
/// vertices.
GLIMMER_TUNABLE_CONSTANT(float, kRouletteScaleInMedium, 1);

/// Probability of going on after so many mirrors and dielectrics in a row. Total internal reflection can hold light in
/// a body for ever without a loss of throughput that the roulette above would see. Both numbers are chosen: such chains
/// carry light that matters only in deliberate constructions, and any survival below 1 ends them.
inline float specular_survival(uint32_t specular_depth) {
    constexpr uint32_t kSpecularDepthWithoutRoulette = 256;
    constexpr float kSpecularSurvival = 0.98f;
    return specular_depth < kSpecularDepthWithoutRoulette ? 1.0f : kSpecularSurvival;
}

} // namespace glimmer
