// SPDX-License-Identifier: GPL-3.0-or-later
// The one table of passes: what --list-aovs prints, what the film keeps and what the add-on registers.
#pragma once

#include "glimmer.h"

#include <array>
#include <cstring>

namespace glimmer {

inline constexpr std::array<glimmer_pass_info_t, GLIMMER_PASS_COUNT> kPasses{{
    {"combined", "RGB", "radiance"},
    {"stderr", "RGB", "standard error of the combined mean"},
    {"albedo", "RGB", "albedo of the first surface that is not a mirror or glass"},
    {"normal", "XYZ", "world shading normal of the first surface"},
    {"depth", "Z", "distance along the camera's axis to the first surface, 1e10 where there is none"},
    {"emission", "RGB", "light seen directly, also through mirrors and glass"},
    {"direct", "RGB", "light scattered once, by a surface"},
    {"indirect", "RGB", "light scattered more than once, first by a surface as seen from the camera"},
    {"fog", "RGB", "light that the fog scattered to the camera"},
    {"object_index", "X", "index of the object at the pixel's first sample, 0 if none"},
    {"material_index", "X", "1 + the material at the pixel's first sample, 0 if none"},
    {"sample_count", "X", "samples of the pixel"},
}};

inline size_t pass_channels(glimmer_pass pass) {
    return std::strlen(kPasses[size_t(pass)].channels);
}

} // namespace glimmer
