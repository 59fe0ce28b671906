// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "math/vec.h"

#include <optional>

namespace glimmer {

/// The cone of a spot: 1 inside, smoothly 0 at its edge, by the cosine of the angle to its axis; times that cosine
/// where it is a spot of Blender until 3.6.
struct SpotCone {
    Vec3f direction;
    float cos_half = -1, smooth = 0;
    bool times_cosine = false;

    float falloff(const Vec3f &from_light) const {
        const float cosine = dot(from_light, direction), over = cosine - cos_half;
        if (over <= 0)
            return 0;
        const float factor = times_cosine ? cosine : 1;
        if (over >= smooth)
            return factor;
        const float s = over / smooth;
        return s * s * (3 - 2 * s) * factor;
    }
};

/// 1 where there is no cone.
inline float falloff(const std::optional<SpotCone> &cone, const Vec3f &from_light) {
    return cone ? cone->falloff(from_light) : 1.0f;
}

} // namespace glimmer
