// SPDX-License-Identifier: GPL-3.0-or-later
// The integrators by name.
#pragma once

#include "glimmer.h"
#include "integrator/depth_limits.h"
#include "integrator/integrator.h"
#include "scene/scene.h"

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace glimmer {

/// The default, the baseline, and the default less one of its estimators each (path/estimator_flags.h). The last member
/// is the name that the integrator had before; it works for one more release.
inline constexpr std::array<glimmer_integrator_info_t, 13> kIntegrators{{
    {"path", "path tracing; fog by light vertices that all pixels share, the camera's segments of it light by light",
     nullptr},
    {"baseline", "the method that Glimmer grew from: one light a place, exponential free flights, balance heuristic",
     "report"},
    {"path-no-split",
     "path, where it comes to free flights at all: direct segments of fog end in it or beyond, not both", nullptr},
    {"path-no-all-lights", "path, but one light a place, not all", nullptr},
    {"path-no-emitter-rays", "path, but no more camera rays where emissive spheres are seen", "path-no-light-rays"},
    {"path-no-branches", "path, but one path goes on from the first surface", nullptr},
    {"path-no-guided-choice", "path, but single lights are chosen all alike", nullptr},
    {"path-no-equiangular", "path, but no light is sampled along direct segments of fog; so without light vertices",
     "path-no-lines"},
    {"path-no-deep-equiangular", "path, but none along later segments; so without light vertices",
     "path-no-deep-lines"},
    {"path-no-late-roulette", "path, but roulette by throughput from the start", nullptr},
    {"path-no-pixel-ris", "path, but one point of a pixel is lit where surfaces glint", "path-no-pixel-points"},
    {"path-no-light-vertices", "path, but light scattered more than once comes from paths alone", nullptr},
    {"path-no-reconstruction", "path, but each sample counts for one pixel, drawn by the pixel's filter", nullptr},
}};

/// The integrator of that name, present or former, as an index into kIntegrators.
std::optional<uint32_t> find_integrator(std::string_view name);

/// "integrator "report" is now called "baseline"" for a former name; empty for a present one.
std::string renamed_integrator(std::string_view name);

/// index: into kIntegrators. passes: bit set of 1 << glimmer_pass, what the film keeps. full_kernel: the code for all
/// scenes, not what was compiled for scenes like this one; both give the same bits.
std::unique_ptr<const Integrator> make_integrator(uint32_t index, const Scene &scene, const DepthLimits &limits,
                                                  uint64_t passes, bool full_kernel);

} // namespace glimmer
