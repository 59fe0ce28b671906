// SPDX-License-Identifier: GPL-3.0-or-later
// What a surface is made of, after mixes were flattened into weighted lobes.
#pragma once

#include "math/vec.h"

#include <cstdint>
#include <string>

namespace glimmer {

/// What holds for a material wherever it is shaded. Plans and the shared light vertices go by these: bounds that are
/// too wide make a picture slower, never wrong.
struct MaterialBounds {
    float max_value = 0; ///< no f cos_o of any channel is larger (see max_value(Bsdf)); infinite with mirrors and glass
    Rgb emission;        ///< radiance; exact where the material does not vary
    bool scatters = false;    ///< any lobe
    bool specular = false;    ///< any mirror or smooth glass
    bool transmits = false;   ///< light passes to the other side
    bool transparent = false; ///< some of it straight through
    bool subsurface = false;  ///< light leaves elsewhere than where it enters
};

struct Material {
    std::string name;
    bool null = false;                       ///< not there at all
    float interior_ior = 0;                  ///< of the body that it bounds; 0: it bounds none
    Rgb emission;                            ///< radiance on both sides
    Rgb transparency;                        ///< what goes straight through
    float holdout = 0;                       ///< the part that is a hole where the camera sees it
    uint32_t lobe_begin = 0, lobe_count = 0; ///< of the table's constant lobes
    uint32_t varying = kConstant;            ///< of ShaderScene::materials
    MaterialBounds bounds;

    static constexpr uint32_t kConstant = 0xffffffffu;
};

} // namespace glimmer
