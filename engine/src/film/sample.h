// SPDX-License-Identifier: GPL-3.0-or-later
// The result of one camera sample.
#pragma once

#include "math/vec.h"

#include <cstdint>

namespace glimmer {

struct FilmSample {
    /// Radiance by the way it came to the camera (see film/passes.h); their sum is the radiance of the sample.
    Rgb emission, direct, indirect, medium;
    Rgb albedo;
    Vec3f normal;
    float depth = 0; ///< along the camera's axis; known only where `hit`
    bool hit = false;
    /// A guard against endless paths broke the sample off: what is missing is a bias.
    bool unfinished = false;
    uint32_t object_index = 0, material_index = 0;

    /// Makes all light a factor brighter.
    void expose(float factor) {
        for (Rgb *part : {&emission, &direct, &indirect, &medium})
            *part *= factor;
    }
    Rgb radiance() const { return emission + direct + indirect + medium; }
};

} // namespace glimmer
