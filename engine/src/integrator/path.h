// SPDX-License-Identifier: GPL-3.0-or-later
// Unidirectional path tracing. Segments seen directly from the camera are split, never tossed a coin over: the light
// that the fog scatters once along them is summed light by light, one path goes on from a point in the fog and one from
// the surface behind.
#pragma once

#include "integrator/integrator.h"

namespace glimmer {

/// The estimators that can be switched, one by one: each changes noise and time, never the mean.
struct PathOptions {
    bool split = true;        ///< direct segments of fog: both ends are followed; else one, by free flight
    bool all_lights = true;   ///< every light is sampled at surfaces (with about two shadow rays beyond the first) and
                              ///< along what the camera sees directly; else one everywhere
    uint32_t light_rays = 16; ///< camera rays more in pixels where spheres that shine are seen (seen_lights.h)
    uint32_t surface_branches = 4; ///< paths that go on from the first surface
    bool guided_choice = true;     ///< one light is chosen by what it could bring; else all alike
    bool line_lights = true; ///< light is sampled along direct segments of fog; else at the collision that ends them
    bool deep_line_lights = true; ///< the same for all later segments
    bool light_vertices =
        true; ///< light scattered more than once comes from vertices shared by all pixels; else from paths alone

    bool operator==(const PathOptions &) const = default;
};

/// The student report's method, kept as a yardstick: one light, exponential free flights, balance heuristic.
inline constexpr PathOptions kReportOptions{false, false, 0, 1, false, false, false, false};

std::unique_ptr<const Integrator> make_path_integrator(const Scene &scene, const DepthLimits &limits,
                                                       const PathOptions &options);

} // namespace glimmer
