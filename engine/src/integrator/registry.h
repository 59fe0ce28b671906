// SPDX-License-Identifier: GPL-3.0-or-later
// The integrators by name.
#pragma once

#include "glimmer.h"
#include "integrator/depth_limits.h"
#include "integrator/integrator.h"
#include "scene/scene.h"

#include <array>
#include <memory>

namespace glimmer {

/// The default, the baseline, and the default less one of its estimators each (path/estimator_flags.h).
inline constexpr std::array<glimmer_integrator_info_t, 12> kIntegrators{{
    {"path", "path tracing; fog by light vertices that all pixels share, the camera's segments of it light by light"},
    {"report", "the student report's method, as a yardstick: one light, exponential free flights, balance heuristic"},
    {"path-no-split",
     "path, where it comes to free flights at all: direct segments of fog end in it or beyond, not both"},
    {"path-no-all-lights", "path, but one light a place, not all"},
    {"path-no-light-rays", "path, but no more camera rays where moons are seen"},
    {"path-no-branches", "path, but one path goes on from the first surface"},
    {"path-no-guided-choice", "path, but single lights are chosen all alike"},
    {"path-no-lines", "path, but no light is sampled along direct segments of fog; so without light vertices"},
    {"path-no-deep-lines", "path, but none along later segments either; so without light vertices"},
    {"path-no-late-roulette", "path, but roulette by throughput from the start"},
    {"path-no-pixel-points", "path, but one point of a pixel is lit where bevels glint"},
    {"path-no-light-vertices", "path, but light scattered more than once comes from paths alone"},
}};

/// index: into kIntegrators. full_kernel: the code for all scenes, not what was compiled for scenes like this one; both
/// give the same bits.
std::unique_ptr<const Integrator> make_integrator(uint32_t index, const Scene &scene, const DepthLimits &limits,
                                                  bool full_kernel);

} // namespace glimmer
