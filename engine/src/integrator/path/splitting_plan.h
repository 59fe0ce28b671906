// SPDX-License-Identifier: GPL-3.0-or-later
// How the path integrator splits a camera sample, by a rule that depends on the scene alone.
#pragma once

#include "integrator/path/estimator_flags.h"
#include "scene/scene.h"

namespace glimmer {

/// Contrast of the RIS target function (ris_target.h) within pixels: its variance at what the camera sees over the
/// square of its mean, from a pilot of pairs of camera rays. 0 without surfaces, or where lights are too many for the
/// target.
double pixel_contrast(const Scene &scene);

struct SplittingPlan {
    uint32_t branches = 1;  ///< paths that go on from the first surface, each with its part of the throughput
    bool pixel_ris = false; ///< several points of the pixel compete for direct light (pixel_ris.inl)
};

/// Where surfaces glint (their contrast exceeds a threshold), points of a pixel compete for being lit, and many
/// branches go on; many also where a medium scatters, whose work along the camera's ray the branches share; else few.
/// The constants are in tuning.h.
SplittingPlan plan_splitting(const Scene &scene, const EstimatorFlags &flags);

} // namespace glimmer
