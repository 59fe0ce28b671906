// SPDX-License-Identifier: GPL-3.0-or-later
// Rays that leave a surface of a light: where light subpaths start.
#pragma once

#include "light/interface.h"
#include "math/rounding.h"
#include "sampling/warp.h"

namespace glimmer {

/// A cosine-distributed ray from a point of a surface of uniform radiance, started off it by the rounding error.
inline Emission emit_from_surface(const Vec3f &position, const Vec3f &normal, float error, const Rgb &radiance,
                                  double area, Vec2f u) {
    const Vec3f local = sample_cosine_hemisphere(u);
    const Vec3f direction = normalize(Frame(normal).to_world(local));
    return {{position + normal * error, direction, {}}, radiance * float(kPiDouble * area)};
}

} // namespace glimmer
