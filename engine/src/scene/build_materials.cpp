// SPDX-License-Identifier: GPL-3.0-or-later
// Materials: mixes are flattened into weighted lobes.
#include "base/error.h"
#include "scene/builder.h"
#include "shading/material_tree.h"

namespace glimmer {

void SceneBuilder::build_materials() {
    for (uint32_t i = 0; i < description_.materials.size(); ++i) {
        Material out;
        const MaterialDescription &m = description_.materials[i];
        out.name = m.label;
        out.null = m.type == MaterialType::null;
        FlatMaterial flat;
        if (!out.null)
            flatten(description_.materials, i, nullptr, flat);
        out.emission = flat.emission;
        out.transparency = flat.transparency;
        out.holdout = flat.holdout;
        set_probabilities(flat.lobes);
        scene_.materials.add(std::move(out), flat.lobes);
    }
    used_.assign(scene_.materials.size(), false);
}

} // namespace glimmer
