// SPDX-License-Identifier: GPL-3.0-or-later
// What one camera sample brings home.
#pragma once

#include "math/vec.h"

#include <cstdint>

namespace glimmer {

struct FilmSample {
    Rgb emission, direct, indirect, medium; ///< radiance by the way it came; their sum is the sample's radiance
    Rgb albedo;
    Vec3f normal;
    float depth = 0; ///< along the axis; only where hit
    bool hit = false;
    bool unfinished = false; ///< broken off by the guard against paths without end: what is missing is a bias
    uint32_t object_index = 0, material_index = 0;

    Rgb radiance() const { return emission + direct + indirect + medium; }
};

} // namespace glimmer
