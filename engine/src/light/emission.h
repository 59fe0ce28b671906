// SPDX-License-Identifier: GPL-3.0-or-later
// Rays that leave a surface of a light: where light subpaths start.
#pragma once

#include "light/interface.h"
#include "sampling/warp.h"

namespace glimmer {

/// Bound on the rounding error of a float32 position, in units of its largest coordinate.
inline constexpr float kPositionError = 0x1p-20f;

/// A cosine-distributed ray from a point of a surface of uniform radiance, started off it by the rounding error.
inline Emission emit_from_surface(const Vec3f &position, const Vec3f &normal, float error, const Rgb &radiance,
                                  double area, Vec2f u) {
    const Vec3f local = sample_cosine_hemisphere(u);
    const Vec3f direction = normalize(Frame(normal).to_world(local));
    return {{position + normal * error, direction}, radiance * float(kPiDouble * area)};
}

} // namespace glimmer
