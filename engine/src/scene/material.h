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

struct Material {
    std::string name;
    MaterialKind kind = MaterialKind::reflective;
    bool schlick = false;                    ///< glass: Schlick in place of the exact Fresnel equations
    float ior = 1;                           ///< glass
    Rgb emission;                            ///< radiance on both sides
    uint32_t lobe_begin = 0, lobe_count = 0; ///< in Scene::lobes
};

} // namespace glimmer
