// SPDX-License-Identifier: GPL-3.0-or-later
// Every constant of the light vertex cache that was not forced by a formula. Sections are those of docs/method.md.
//   derived:  follows from the formula or the argument that is named.
//   measured: `build.py bench --tuning NAME` varies the constant and prints variance times CPU time against this value.
//   chosen:   set by hand; nobody has to believe that it is the best value. The same command varies most of them.
// None of them changes the mean of light transport, only its noise and its time.
#pragma once

#include "base/tunable.h"

#include <cstddef>
#include <cstdint>

namespace glimmer::tuning {

// -- When the cache serves at all (section 9)

/// Henyey-Greenstein g beyond which two phase functions that meet in one connection outweigh what the cache saves.
/// Chosen.
GLIMMER_TUNABLE_CONSTANT(float, kMostForwardG, 0.9f);
GLIMMER_TUNABLE_CONSTANT(float, kMostBackwardG, -0.6f);
/// The cache is left out where the scene's radius is more than kDenseRadius mean free paths and less than
/// kDiffuseRadius effective attenuation lengths: light then wanders through all of the scene, and few of a subpath's
/// thousands of vertices lie where the camera looks. Chosen.
GLIMMER_TUNABLE_CONSTANT(float, kDenseRadius, 50);
GLIMMER_TUNABLE_CONSTANT(float, kDiffuseRadius, 5);

// -- How many subpaths, gather points and picks (section 8)

/// Pixels for one light subpath of a wave. Measured. Where only the medium scatters, subpaths are cheap and the error
/// that all pixels share is a larger part of the whole.
GLIMMER_TUNABLE_CONSTANT(uint32_t, kPixelsPerPath, 6);
GLIMMER_TUNABLE_CONSTANT(uint32_t, kPixelsPerPathInMediumAlone, 3);
/// Bounds on the subpaths of a wave. Chosen: below the first a small picture has too few vertices for its blocks;
/// beyond the second the time goes into blocks that each look at every vertex.
GLIMMER_TUNABLE_CONSTANT(uint32_t, kFewestPaths, 512);
GLIMMER_TUNABLE_CONSTANT(uint32_t, kMostPaths, 24576);
/// Vertices of a wave at which the number of subpaths is reduced, for the same reason and for memory; and the number
/// of subpaths that are left in any case. Chosen.
GLIMMER_TUNABLE_CONSTANT(uint32_t, kMostVertices, 1u << 18);
GLIMMER_TUNABLE_CONSTANT(uint32_t, kFewestPathsOfManyVertices, 64);
/// Gather points on a segment of medium that the camera sees directly. Measured. Where surfaces scatter too, much of
/// the error is theirs and fewer gather points pay.
GLIMMER_TUNABLE_CONSTANT(uint32_t, kGathers, 4);
GLIMMER_TUNABLE_CONSTANT(uint32_t, kGathersInMediumAlone, 8);
/// Interleaved subsets of a block's picks; a gather point takes one of them. Measured: 24 to 40 are alike, 8 leave more
/// error to blocks.
GLIMMER_TUNABLE_CONSTANT(uint32_t, kSubsets, 24);
/// From one gather point of a segment to the next, in subsets. Derived: the two have no common divisor, so that as many
/// gather points as there are subsets see all picks.
GLIMMER_TUNABLE_CONSTANT(uint32_t, kSubsetStride, 5);
/// Picks in one subset. Chosen; medium picks fill whole SIMD registers. Not tunable, as arrays have these sizes.
inline constexpr size_t kMediumPicks = 128;
inline constexpr size_t kSurfacePicks = 8;

// -- The pilot that sets lengths (section 8)

/// Gather points at which the density of vertices is looked up, and the neighbour that the density is taken from.
/// Chosen.
GLIMMER_TUNABLE_CONSTANT(uint32_t, kPilotPoints, 64);
GLIMMER_TUNABLE_CONSTANT(uint32_t, kPilotNeighbours, 8);
/// Light subpaths of the pilot at most. Chosen.
GLIMMER_TUNABLE_CONSTANT(uint32_t, kMostPilotPaths, 2048);

// -- Clamp distances (sections 4 and 8)

/// Clamp distance in mean free paths where the pilot found too few vertices to know a density. Chosen.
GLIMMER_TUNABLE_CONSTANT(float, kClampDistanceWithoutVertices, 0.1f);
/// Upper bound on the clamp distance in mean free paths, before it grows with the phase function's peak. Derived:
/// beyond one, a compensation ray is an ordinary free flight and the connections bring next to nothing.
GLIMMER_TUNABLE_CONSTANT(float, kMostClampDistance, 1);
/// Clamp distance towards surface vertices over that towards medium vertices. Chosen.
GLIMMER_TUNABLE_CONSTANT(float, kSurfaceClampFactor, 2);
/// The clamp distance grows with this power of the phase function's peak over the isotropic value: two peaks that meet
/// are rarer and brighter. Chosen, about the square root for d0 squared.
GLIMMER_TUNABLE_CONSTANT(float, kClampPowerOfPhasePeak, 0.25f);
/// Clamp distance of splats over the median distance of the gather points from the camera. Chosen.
GLIMMER_TUNABLE_CONSTANT(float, kSplatClampFactor, 0.03f);
/// The clamp distances grow beyond this many median distances from the camera. Measured.
GLIMMER_TUNABLE_CONSTANT(float, kFarMedians, 2);
/// Upper bound on that growth. Derived: it need only be finite, and no connection brings anything there.
GLIMMER_TUNABLE_CONSTANT(float, kMostClampScale, 1e6f);

// -- The bounded fraction of the BSDF (section 5)

/// Upper bound, per steradian, on f cos(theta_o) in a connection. Chosen above 1/pi, so that no diffuse surface reaches
/// it. It may not differ between the vertices and the paths that bring the remainder, which is why both read it here.
inline constexpr float kBsdfBound = 1;
static_assert(kBsdfBound > 0.3183099f, "a white diffuse surface must stay below the bound");

// -- Light subpaths (section 6)

/// Share of the subpaths whose light is chosen by power and importance; the rest start at all lights alike. Chosen.
GLIMMER_TUNABLE_CONSTANT(float, kStartsByImportance, 0.85f);
/// Gather points that the importance map is made of. Chosen.
GLIMMER_TUNABLE_CONSTANT(uint32_t, kImportancePoints, 32);
/// Squared softening of the importance map about each of its points, in squared mean free paths. Chosen.
GLIMMER_TUNABLE_CONSTANT(float, kImportanceSoftening2, 0.25f);
/// Factor on the weight that the window compares with 1: roulette starts that much later and splitting that much
/// earlier. Measured.
GLIMMER_TUNABLE_CONSTANT(float, kWindowScale, 1.5f);
/// Weight above which a subpath splits, and the largest number of its parts. Chosen.
GLIMMER_TUNABLE_CONSTANT(float, kSplitAbove, 1.5f);
GLIMMER_TUNABLE_CONSTANT(float, kMostParts, 8);
/// Light from afar is aimed at regions about the media: from one to the next the factor of their radii, and the sine of
/// the half angle of the widest cone from a light. Chosen.
GLIMMER_TUNABLE_CONSTANT(float, kAimGrowth, 4);
GLIMMER_TUNABLE_CONSTANT(float, kWidestCone, 0.5f);
/// Directions drawn at a surface vertex for splats of the remainder of its BSDF, for a subpath of weight 1; and the
/// weight up to which the number grows (a subpath straight from a distant light may weigh thousands). Chosen.
GLIMMER_TUNABLE_CONSTANT(uint32_t, kSplatDirections, 32);
GLIMMER_TUNABLE_CONSTANT(float, kMostSplatWeight, 64);
/// Points on one segment that are splatted. Chosen.
GLIMMER_TUNABLE_CONSTANT(uint32_t, kSplatPoints, 2);
/// Shares of the samples that are drawn about the geometric normal where the shading normal differs: of rough
/// lobes, of mirrors, of dielectrics. Chosen; any value in (0, 1) is correct.
GLIMMER_TUNABLE_CONSTANT(float, kGeometricNormalShare, 0.125f);
GLIMMER_TUNABLE_CONSTANT(float, kGeometricMirrorShare, 0.25f);
GLIMMER_TUNABLE_CONSTANT(float, kGeometricDielectricShare, 0.5f);

// -- Picking the vertices of a block (section 7)

/// Gather points that stand for a block. Chosen.
GLIMMER_TUNABLE_CONSTANT(uint32_t, kBlockPoints, 12);
/// Share of the picks that follow the target; the rest are uniform over all vertices, so that none has probability 0
/// and no weight exceeds 1 / (1 - this) of the average. Chosen.
GLIMMER_TUNABLE_CONSTANT(float, kPicksByTarget, 0.7f);
/// Factor on the clamp distance inside the target, for gather points that are not among the block's. Chosen.
GLIMMER_TUNABLE_CONSTANT(float, kTargetClampFactor, 3);
/// Added to the cosine at a surface vertex in its target, for gather points on the other side of its horizon. Chosen.
GLIMMER_TUNABLE_CONSTANT(float, kTargetCosineFloor, 0.01f);
/// Part of the power that counts in a surface vertex's target beside its reflected power, so that lobes which reflect
/// little in the mean are not lost. Chosen.
GLIMMER_TUNABLE_CONSTANT(float, kTargetPowerFloor, 1e-6f);

} // namespace glimmer::tuning
