// SPDX-License-Identifier: GPL-3.0-or-later
// The constants of the path integrator that are neither physics nor interface, each with its source. None of them
// changes the mean of a picture, only its noise and the time that it takes.
//
//   derived:  follows from the argument that is given.
//   measured: `build.py bench --tuning NAME` varies the constant and prints variance times CPU time against this value.
//   chosen:   set by hand; nobody has to believe that it is the best value.
#pragma once

#include "base/tunable.h"
#include "sampling/dimensions.h"

#include <cstddef>
#include <cstdint>

namespace glimmer::tuning {

// Choice of lights (path_sample.h)

/// Most lights of a scene that are all sampled at what the camera sees; with more, some are chosen. Chosen: that many
/// table look-ups and shadow rays cost about as much as the rest of a sample.
inline constexpr uint32_t kMaxLightsSampledEach = 16;
/// Lights chosen at what the camera sees where the scene has more of them. Chosen.
inline constexpr uint32_t kLightsChosenOfMany = 4;
static_assert(kLightsChosenOfMany <= kMaxLightsSampledEach, "the candidates of a surface have room for so many");
static_assert(kMaxLightsSampledEach <= dimension_count(Dimension::segment_distance) &&
                  kMaxLightsSampledEach <= dimension_count(Dimension::segment_light) &&
                  kMaxLightsSampledEach <= dimension_count(Dimension::surface_light),
              "every light of a sample needs numbers of its own");

/// Most lights infinitely far away that are all sampled where a path scatters in a medium; of more, one is. Chosen.
inline constexpr uint32_t kInfiniteLightsSampledEach = 4;

/// Expected number of shadow rays at a surface that the camera does not see first, where every light is sampled: each
/// light gets its ray with a probability that follows its part of the sum. Chosen.
GLIMMER_TUNABLE_CONSTANT(float, kShadowRaysBeyondFirstSurface, 2);

// Splitting (splitting_plan.h)

/// Paths that go on from the first surface: where its light varies much within a pixel or a medium scatters, whose work
/// along the camera's ray the branches share; and elsewhere. Measured.
GLIMMER_TUNABLE_CONSTANT(uint32_t, kBranchesWhereVaried, 4);
GLIMMER_TUNABLE_CONSTANT(uint32_t, kBranchesElsewhere, 2);
#ifndef GLIMMER_TUNABLE
static_assert(kBranchesElsewhere <= kBranchesWhereVaried &&
                  kBranchesWhereVaried <= dimension_count(Dimension::branch_lobe) &&
                  kBranchesWhereVaried <= dimension_count(Dimension::branch_direction),
              "every branch needs numbers of its own");
#endif
/// Pixel contrast (variance over squared mean, see pixel_contrast) above which surfaces count as glinting. Measured:
/// rough metal, whose contrast is lower, loses by the candidates of pixel_ris.inl; smooth bevels gain.
GLIMMER_TUNABLE_CONSTANT(double, kContrastOfGlints, 0.8);
/// Pairs of camera rays of the pilot that estimates the contrast. Chosen: a few milliseconds.
inline constexpr uint32_t kContrastPilotPairs = 4096;
/// Branches of one camera sample still to follow, beyond which a segment is no longer split into two. Chosen: far
/// above what a path needs, it only keeps rows of mirrors from doubling their branches each time.
inline constexpr size_t kMaxOpenBranches = 24;

// Resampled direct light of a pixel (pixel_ris.inl)

/// Candidates lie in a grid of so many strata a side of the pixel. Chosen.
inline constexpr uint32_t kRisStrataPerSide = 2;
inline constexpr uint32_t kRisCandidates = kRisStrataPerSide * kRisStrataPerSide;
static_assert(kRisCandidates <= dimension_count(Dimension::candidate_film), "every candidate needs numbers of its own");
/// Part of the choice that is uniform over the candidates, for light that the target function did not expect. Bounds
/// the weights by kRisCandidates over this. Chosen.
GLIMMER_TUNABLE_CONSTANT(float, kRisUniformFraction, 0.1f);

// Bounds of lights (segment.inl)

/// Factor on the radius of a light's bounding sphere, and summand relative to the distance of its centre, both well
/// beyond any rounding: a ray that passes outside meets no light. Derived: float32 rounds at 6e-8.
inline constexpr float kLightBoundFactor = 1.001f;
inline constexpr float kLightBoundMargin2 = 1e-6f; ///< relative to the squared distance

} // namespace glimmer::tuning
