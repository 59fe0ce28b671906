// SPDX-License-Identifier: GPL-3.0-or-later
// A camera path on its way along one segment, and what light sampling could have done at the vertex where the segment
// began. Stacks of paths are copied a lot: parts that a kernel has no use for take no room.
#pragma once

#include "geometry/ray.h"
#include "integrator/features.h"
#include "integrator/glass_stack.h"
#include "math/vec.h"

#include <type_traits>

namespace glimmer {

/// In place of a part that a kernel has no use for.
template <int>
struct Absent {};
struct NoGlass {
    static constexpr bool empty() { return true; }
};

/// How the direction of a segment came about.
enum class DirectionKind : uint8_t {
    specular, ///< the camera, a mirror, glass: light sampling cannot do the same
    surface,  ///< a BSDF sample at `position`
    fog       ///< a phase sample at `position`, which was itself sampled on a segment
};

/// The segment in the fog that a collision was sampled on, and the density of its distance there.
struct SegmentOrigin {
    Vec3f origin, direction;
    float end = 0, distance = 0, distance_pdf = 0;
};

/// For the multiple importance sampling of a light that the segment meets.
template <Features F>
struct DirectionOrigin {
    DirectionKind kind = DirectionKind::specular;
    bool all_lights = false; ///< light sampling took every light there, not one
    bool along = false;      ///< fog: light was sampled along the segment, not at `position`
    float pdf = 0;           ///< of the direction, per solid angle
    Vec3f position;
    [[no_unique_address]] std::conditional_t<F.fog_walks, SegmentOrigin, Absent<0>> segment; ///< fog
};

/// What scattered first, specular surfaces apart.
enum class First : uint8_t { none, surface, fog };

/// Lights that a segment meets by chance.
enum class Met : uint8_t {
    counted,
    elsewhere, ///< other samples bring all of their light
    alone      ///< the segment is wanted for nothing else
};

template <Features F>
struct PathState {
    Ray ray;
    Rgb beta{1}; ///< throughput
    float exempt =
        1; ///< the part of beta that roulette must not see: absorption before the first scattering, 1/eta^2 of glass
    [[no_unique_address]] std::conditional_t<F.meets_lights(), DirectionOrigin<F>, Absent<1>> origin;
    uint32_t depth = 0, scatter = 0; ///< vertices so far; in the fog
    First first = First::none;
    Met met = Met::counted;
    uint32_t order = 0; ///< vertices since then
    uint32_t chain = 0; ///< mirrors and glass in a row, up to here
    [[no_unique_address]] std::conditional_t<F.glass, GlassStack, NoGlass> glass;

    /// A ray from a point in the fog that the pool has already given its light, but for what bounded connections leave
    /// out: a vertex in the fog or on a surface counts no further than here. Infinite for every other segment.
    float fog_reach = kInfinity, surface_reach = kInfinity;
    bool compensates() const { return F.fog && fog_reach < kInfinity; }
    bool splatted = false; ///< such a ray, where splats bring what no vertex holds (splat.h)

    /// Seen from the camera with nothing but mirrors and glass between.
    bool direct_view() const { return first == First::none; }
};

} // namespace glimmer
