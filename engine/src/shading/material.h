// SPDX-License-Identifier: GPL-3.0-or-later
// What a surface is made of, after mixes were flattened into weighted lobes.
#pragma once

#include "math/vec.h"

#include <cstdint>
#include <string>

namespace glimmer {

enum class MaterialKind : uint8_t {
    reflective, ///< opaque: a sum of lobes, maybe emissive
    glass,      ///< a smooth dielectric
    light,      ///< opaque, black, radiant
    null        ///< not there
};

/// What holds for a material wherever it is shaded. Plans and the shared light vertices go by these: bounds that are
/// too wide make a picture slower, never wrong.
struct MaterialBounds {
    float max_value = 0; ///< no f cos_o of any channel is larger (see max_value(Bsdf)); infinite with mirrors and glass
    Rgb emission;        ///< radiance; exact where the material does not vary
    bool scatters = false; ///< any lobe
    bool specular = false; ///< any mirror or glass
};

struct Material {
    std::string name;
    MaterialKind kind = MaterialKind::reflective;
    bool schlick = false;                    ///< glass: Schlick in place of the exact Fresnel equations
    float ior = 1;                           ///< glass
    Rgb emission;                            ///< radiance on both sides
    uint32_t lobe_begin = 0, lobe_count = 0; ///< of the table's constant lobes
    MaterialBounds bounds;
};

} // namespace glimmer
