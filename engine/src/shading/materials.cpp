// SPDX-License-Identifier: GPL-3.0-or-later
#include "shading/materials.h"

#include "shading/material_tree.h"

namespace glimmer {

void Materials::add(Material material, std::span<const WeightedLobe> lobes) {
    const Bsdf bsdf(lobes);
    material.bounds = {.max_value = max_value(bsdf),
                       .emission = material.emission,
                       .scatters = !bsdf.empty(),
                       .specular = has_specular(bsdf),
                       .transmits = transmits(bsdf),
                       .transparent = !is_black(material.transparency),
                       .subsurface = has_subsurface(bsdf)};
    material.interior_ior = interior_ior(lobes);
    material.lobe_begin = uint32_t(lobes_.size());
    material.lobe_count = uint32_t(lobes.size());
    lobes_.insert(lobes_.end(), lobes.begin(), lobes.end());
    materials_.push_back(std::move(material));
}

void Materials::set_varying(uint32_t material, uint32_t varying, const MaterialBounds &bounds, float interior_ior) {
    materials_[material].varying = varying;
    materials_[material].bounds = bounds;
    materials_[material].interior_ior = interior_ior;
}

} // namespace glimmer
