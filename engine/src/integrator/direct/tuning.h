// SPDX-License-Identifier: GPL-3.0-or-later
// The constants of what concerns the camera's own rays alone; how they are marked: ../path/tuning.h.
#pragma once

#include "base/tunable.h"

#include <cstdint>

namespace glimmer::tuning {

// Emitter rays (emitter_rays.h)

/// Camera rays that a sample adds in pixels that an emissive sphere touches, in a square grid of strata. Chosen.
inline constexpr uint32_t kEmitterRayStrataPerSide = 4;
inline constexpr uint32_t kEmitterRays = kEmitterRayStrataPerSide * kEmitterRayStrataPerSide;
/// Most spheres that a pixel is compared with; scenes of more get no such rays. Chosen: beyond, the comparison costs
/// more than the rays.
inline constexpr uint32_t kMostSilhouettes = 64;

// The RIS target function (ris_target.h)

/// Least cosine of any direction: a place at the edge of seeing a light may still see some of it. Chosen.
GLIMMER_TUNABLE_CONSTANT(float, kLeastTargetCosine, 1e-3f);
/// Part of a light's angular half width (as a sine) that adds to the width of a lobe, squared, and part of it that is
/// the least cosine of a diffuse lobe towards a light half below the horizon. Chosen.
inline constexpr float kLightWidthInLobe2 = 0.25f;
inline constexpr float kLightAboveHorizon = 0.5f;

} // namespace glimmer::tuning
