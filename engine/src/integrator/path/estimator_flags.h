// SPDX-License-Identifier: GPL-3.0-or-later
// The estimators of the path integrator that can be switched off, one by one or all together.
#pragma once

namespace glimmer {

/// Each changes noise and time, never the mean.
struct EstimatorFlags {
    /// Segments of the medium that the camera sees are followed to both ends, into the medium and to the surface
    /// behind; else to one of them, by free flight. (splitting_plan.h)
    bool split = true;
    /// All lights are sampled at surfaces, with about two shadow rays beyond the first, and along the segments that the
    /// camera sees; else one light at each place.
    bool all_lights = true;
    /// More camera rays in pixels where emissive spheres are seen. (emitter_rays.h)
    bool emitter_rays = true;
    /// Several paths go on from the first surface; else one. (splitting_plan.h)
    bool branch = true;
    /// Where one light is sampled it is chosen by a bound on what it could bring; else uniformly.
    bool guided_choice = true;
    /// On segments that the camera sees, light is sampled along the segment; else at the point where the path scatters.
    bool equiangular = true;
    /// The same for all later segments.
    bool deep_equiangular = true;
    /// Roulette ends no path before its weight has fallen to a fraction of one (roulette.h); else it starts at once.
    bool late_roulette = true;
    /// Where bevels glint, several points of a pixel compete for being lit; else one is lit. (pixel_ris.inl)
    bool pixel_ris = true;
    /// Light that was scattered before reaches the medium by light vertices; else by the paths alone. (../vpl)
    bool light_vertices = true;
    /// Samples count for every pixel whose filter holds them; else for one, by filter importance sampling.
    /// (film/film.h)
    bool reconstruction = true;

    bool operator==(const EstimatorFlags &) const = default;
};
inline constexpr EstimatorFlags kAllEstimators;

/// The baseline that the others are measured against, the method of the student report that Glimmer began as: one light
/// a place, exponential free flights, balance heuristic.
inline constexpr EstimatorFlags kBaselineFlags{false, false, false, false, false, false,
                                               false, false, false, false, false};

} // namespace glimmer
