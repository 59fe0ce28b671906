// SPDX-License-Identifier: GPL-3.0-or-later
// A camera path on its way along one segment, and what light sampling could have done at the vertex where the segment
// began.
#pragma once

#include "geometry/ray.h"
#include "integrator/glass_stack.h"
#include "math/vec.h"

namespace glimmer {

/// How the direction of a segment came about, for the multiple importance sampling of a light that it meets.
struct DirectionOrigin {
    enum class Kind : uint8_t {
        specular, ///< the camera, a mirror, glass: light sampling cannot do the same
        surface,  ///< a BSDF sample at `position`
        fog       ///< a phase sample at `position`, which was itself sampled on a segment
    };
    Kind kind = Kind::specular;
    bool all_lights = false; ///< light sampling took every light there, not one
    bool along = false;      ///< fog: light was sampled along the segment, not at `position`
    float pdf = 0;           ///< of the direction, per solid angle
    Vec3f position;
    // fog: the segment and the density of the collision's distance on it
    Vec3f segment_origin, segment_direction;
    float segment_end = 0, distance = 0, distance_pdf = 0;
};

struct PathState {
    Ray ray;
    Rgb beta{1}; ///< throughput
    float exempt =
        1; ///< the part of beta that roulette must not see: absorption before the first scattering, 1/eta^2 of glass
    DirectionOrigin origin;
    uint32_t depth = 0, scatter = 0; ///< vertices so far; in the fog
    enum class First : uint8_t {
        none,
        surface,
        fog
    } first = First::none; ///< what scattered first, specular surfaces apart
    uint32_t order = 0;    ///< vertices since then
    uint32_t chain = 0;    ///< mirrors and glass in a row, up to here
    GlassStack glass;

    /// A ray from a point in the fog that the pool has already given its light, but for what bounded connections leave
    /// out: a vertex in the fog or on a surface counts no further than here. Infinite for every other segment.
    float fog_reach = kInfinity, surface_reach = kInfinity;
    bool compensates() const { return fog_reach < kInfinity; }
    bool splatted = false; ///< such a ray, where splats bring what no vertex holds (splat.h)

    /// Seen from the camera with nothing but mirrors and glass between.
    bool direct_view() const { return first == First::none; }
};

} // namespace glimmer
