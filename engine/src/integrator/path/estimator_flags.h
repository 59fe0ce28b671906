// SPDX-License-Identifier: GPL-3.0-or-later
// The estimators of the path integrator that can be switched.
#pragma once

namespace glimmer {

/// The estimators that can be switched, one by one: each changes noise and time, never the mean.
struct EstimatorFlags {
    bool split = true;         ///< direct segments of medium: both ends are followed; else one, by free flight
    bool all_lights = true;    ///< every light is sampled at surfaces (with about two shadow rays beyond the first) and
                               ///< along what the camera sees directly; else one everywhere
    bool light_rays = true;    ///< more camera rays in pixels where spheres that shine are seen (emitter_rays.h)
    bool branch = true;        ///< several paths go on from the first surface (path_plan.h); else one
    bool guided_choice = true; ///< one light is chosen by what it could bring; else all alike
    bool segment_lights =
        true; ///< light is sampled along direct segments of medium; else at the collision that ends them
    bool deep_segment_lights = true; ///< the same for all later segments
    bool late_roulette = true; ///< roulette spares paths until little is left of them (roulette.h); else from the start
    bool pixel_points = true;  ///< where bevels glint, several points of a pixel compete for being lit; else one is
    bool light_vertices =
        true; ///< light scattered more than once comes from vertices shared by all pixels; else from paths alone

    bool operator==(const EstimatorFlags &) const = default;
};
inline constexpr EstimatorFlags kAllEstimators;

/// The student report's method, kept as a yardstick: one light, exponential free flights, balance heuristic.
inline constexpr EstimatorFlags kBaselineFlags{false, false, false, false, false, false, false, false, false, false};

} // namespace glimmer
