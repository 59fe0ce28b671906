// SPDX-License-Identifier: GPL-3.0-or-later
#include "shading/materials.h"

namespace glimmer {

void Materials::add(Material material, std::span<const WeightedLobe> lobes) {
    const Bsdf bsdf(lobes);
    material.bounds = {.max_value = max_value(bsdf),
                       .emission = material.emission,
                       .scatters = !bsdf.empty(),
                       .specular = has_specular(bsdf),
                       .transmits = transmits(bsdf),
                       .transparent = !is_black(material.transparency)};
    for (const WeightedLobe &l : lobes)
        if (const auto *dielectric = std::get_if<Dielectric>(&l.lobe))
            material.interior_ior = dielectric->ior;
    material.lobe_begin = uint32_t(lobes_.size());
    material.lobe_count = uint32_t(lobes.size());
    lobes_.insert(lobes_.end(), lobes.begin(), lobes.end());
    materials_.push_back(std::move(material));
}

} // namespace glimmer
