// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "math/vec.h"

#include <optional>

namespace glimmer {

/// The cone of a spot: 1 inside, smoothly 0 at its edge, by the cosine of the angle to its axis.
struct SpotCone {
    Vec3f direction;
    float cos_half = -1, smooth = 0;

    float falloff(const Vec3f &from_light) const {
        const float over = dot(from_light, direction) - cos_half;
        if (over <= 0)
            return 0;
        if (over >= smooth)
            return 1;
        const float s = over / smooth;
        return s * s * (3 - 2 * s);
    }
};

/// 1 where there is no cone.
inline float falloff(const std::optional<SpotCone> &cone, const Vec3f &from_light) {
    return cone ? cone->falloff(from_light) : 1.0f;
}

} // namespace glimmer
