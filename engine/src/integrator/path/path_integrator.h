// SPDX-License-Identifier: GPL-3.0-or-later
// Unidirectional path tracing. Segments seen directly from the camera are split, never tossed a coin over: the light
// that the medium scatters once along them is summed light by light, one path goes on from a point in the medium and
// one from the surface behind.
#pragma once

#include "integrator/depth_limits.h"
#include "integrator/integrator.h"
#include "integrator/path/estimator_flags.h"
#include "scene/scene.h"

#include <memory>

namespace glimmer {

/// full_kernel: the one with all features; else the least that the scene can do with. Both give the same bits.
std::unique_ptr<const Integrator> make_path_integrator(const Scene &scene, const DepthLimits &limits,
                                                       const EstimatorFlags &flags, bool full_kernel = false);

} // namespace glimmer
