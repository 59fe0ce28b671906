// SPDX-License-Identifier: GPL-3.0-or-later
// A camera path on its way along one segment, and what light sampling could have done at the vertex where the segment
// began. Stacks of paths are copied a lot: parts that a kernel has no use for take no room.
#pragma once

#include "geometry/ray.h"
#include "integrator/path/kernel_features.h"
#include "math/vec.h"
#include "medium/interior_stack.h"

#include <type_traits>

namespace glimmer {

/// In place of a part that a kernel has no use for.
template <int>
struct Absent {};
struct NoGlass {
    static constexpr bool empty() { return true; }
};

/// How the direction of a segment came about.
enum class ScatterKind : uint8_t {
    specular, ///< the camera, a mirror, glass: light sampling cannot do the same
    surface,  ///< a BSDF sample at `position`
    medium    ///< a phase sample at `position`, which was itself sampled on a segment
};

/// The segment in the medium that a collision was sampled on, and the density of its distance there.
struct PreviousSegment {
    Vec3f origin, direction;
    float end = 0, distance = 0, distance_pdf = 0;
};

/// For the multiple importance sampling of a light that the segment meets.
template <KernelFeatures F>
struct PreviousVertex {
    ScatterKind kind = ScatterKind::specular;
    bool all_lights = false; ///< light sampling took every light there, not one
    bool along = false;      ///< medium: light was sampled along the segment, not at `position`
    float pdf = 0;           ///< of the direction, per solid angle
    Vec3f position;
    [[no_unique_address]] std::conditional_t<F.medium_walks, PreviousSegment, Absent<0>> segment; ///< medium
};

/// What scattered first, specular surfaces apart.
enum class PathClass : uint8_t { none, surface, medium };

/// Lights that a segment meets by chance.
enum class EmissionMode : uint8_t {
    mis,
    skip, ///< other samples bring all of their light
    only  ///< the segment is wanted for nothing else
};

template <KernelFeatures F>
struct PathState {
    Ray ray;
    Rgb beta{1}; ///< throughput
    float rr_scale =
        1; ///< the part of beta that roulette must not see: absorption before the first scattering, 1/eta^2 of glass
    [[no_unique_address]] std::conditional_t<F.meets_lights(), PreviousVertex<F>, Absent<1>> origin;
    uint32_t depth = 0, scatter = 0; ///< vertices so far; in the medium
    PathClass path_class = PathClass::none;
    EmissionMode emission_mode = EmissionMode::mis;
    uint32_t depth_since_first = 0; ///< vertices since then
    uint32_t specular_depth = 0;    ///< mirrors and glass in a row, up to here
    [[no_unique_address]] std::conditional_t<F.glass, InteriorStack, NoGlass> glass;

    /// A ray from a point in the medium that the pool has already given its light, but for what bounded connections
    /// leave out: a vertex in the medium or on a surface counts no further than here. Infinite for every other segment.
    float medium_compensation_radius = kInfinity, surface_compensation_radius = kInfinity;
    bool compensates() const { return F.medium && medium_compensation_radius < kInfinity; }
    bool splatted = false; ///< such a ray, where splats bring what no vertex holds (splat.h)

    /// Seen from the camera with nothing but mirrors and glass between.
    bool direct_view() const { return path_class == PathClass::none; }
};

} // namespace glimmer
