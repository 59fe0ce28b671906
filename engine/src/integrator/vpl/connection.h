// SPDX-License-Identifier: GPL-3.0-or-later
// A surface vertex as the end of a connection (docs/method.md, section 5).
#pragma once

#include "bsdf/bsdf.h"
#include "integrator/vpl/light_vertices.h"

namespace glimmer {

struct Connection {
    /// f(incoming, direction) |incoming.ns| / |incoming.ng| |direction.ng|, per steradian: the part of the vertex's
    /// power that leaves towards `direction`, as a camera path that arrives from there would count it.
    Rgb factor;
    /// Fraction of it that connections bring (bounded_fraction.h); paths and splats bring the rest.
    float bounded = 1;
};

/// bsdf: of the vertex's material. direction: unit, away from the surface. All zero on the other side
/// of the surface, unless vertex.both_sides.
Connection connect(const SurfaceVertex &vertex, const Bsdf &bsdf, const Vec3f &direction);

} // namespace glimmer
