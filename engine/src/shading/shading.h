// SPDX-License-Identifier: GPL-3.0-or-later
// What a surface is at one point: its closures, what it emits and what it lets through.
#pragma once

#include "bsdf/bsdf.h"

namespace glimmer {

/// A point of a material.
struct Shading {
    Bsdf bsdf; ///< stands in the scene or in the arena that it was shaded into
    Rgb emission;
    Rgb transparency;       ///< the part of light that goes straight through, as if there were no surface
    float interior_ior = 0; ///< of the body that the surface bounds; 0: none
    float holdout = 0;      ///< the part that is a hole where the camera sees it
};

/// What depth, normals and indices show is the surface behind it.
inline bool is_mostly_seen_through(const Shading &shading) {
    return max_component(shading.transparency) > 0.5f;
}

} // namespace glimmer
