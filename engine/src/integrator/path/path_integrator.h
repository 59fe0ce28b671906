// SPDX-License-Identifier: GPL-3.0-or-later
// The path integrator: camera paths with next-event estimation and multiple importance sampling, and a cache of light
// vertices for what the medium scatters more than once. docs/method.md derives it.
#pragma once

#include "integrator/depth_limits.h"
#include "integrator/integrator.h"
#include "integrator/path/estimator_flags.h"
#include "scene/scene.h"

#include <memory>

namespace glimmer {

/// passes: bit set of 1 << glimmer_pass, what the film keeps. full_kernel: take the kernel with all features, not the
/// smallest that serves; both give the same bits.
std::unique_ptr<const Integrator> make_path_integrator(const Scene &scene, const DepthLimits &limits,
                                                       const EstimatorFlags &flags, uint64_t passes = 0,
                                                       bool full_kernel = false);

} // namespace glimmer
