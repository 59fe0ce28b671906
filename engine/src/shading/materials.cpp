// SPDX-License-Identifier: GPL-3.0-or-later
#include "shading/materials.h"

namespace glimmer {

void Materials::add(Material material, std::span<const WeightedLobe> lobes) {
    const Bsdf bsdf(lobes);
    const bool glass = material.kind == MaterialKind::glass;
    material.bounds = {glass ? kInfinity : max_value(bsdf), material.emission, glass || !bsdf.empty(),
                       glass || has_specular(bsdf)};
    material.lobe_begin = uint32_t(lobes_.size());
    material.lobe_count = uint32_t(lobes.size());
    lobes_.insert(lobes_.end(), lobes.begin(), lobes.end());
    materials_.push_back(std::move(material));
}

} // namespace glimmer
