// SPDX-License-Identifier: GPL-3.0-or-later
// Materials: mixes are flattened into weighted lobes.
#include "base/error.h"
#include "scene/builder.h"

#include <stdexcept>

namespace glimmer {

namespace {

/// A material that is a single lobe.
Lobe to_lobe(const MaterialDescription &m) {
    switch (m.type) {
    case MaterialType::lambert:
        return Lambert{m.albedo};
    case MaterialType::mirror:
        return Mirror{m.reflectance};
    case MaterialType::conductor:
        return Conductor{m.alpha, m.alternative == 2, m.eta, m.k, m.f0, m.masking, m.f90};
    case MaterialType::report_metal:
        return BaselineMetal{m.albedo, m.f0, m.alpha};
    case MaterialType::glass:
    case MaterialType::mix:
    case MaterialType::light:
    case MaterialType::null:
    case MaterialType::count:
        break;
    }
    throw std::logic_error("material \"" + m.label + "\" is no lobe");
}

} // namespace

void SceneBuilder::flatten(uint32_t index, float weight, std::vector<WeightedLobe> &lobes, Rgb &emission) const {
    const MaterialDescription &m = description_.materials[index];
    emission += m.emission * weight;
    if (m.type == MaterialType::mix) {
        flatten(m.a, weight * m.weight, lobes, emission);
        flatten(m.b, weight * (1 - m.weight), lobes, emission);
    } else if (weight > 0) {
        lobes.push_back({to_lobe(m), weight, 0});
    }
}

void SceneBuilder::build_materials() {
    for (uint32_t i = 0; i < description_.materials.size(); ++i) {
        const MaterialDescription &m = description_.materials[i];
        Material out;
        out.name = m.label;
        std::vector<WeightedLobe> lobes;
        switch (m.type) {
        case MaterialType::glass:
            out.kind = MaterialKind::glass;
            out.ior = m.ior;
            out.schlick = m.fresnel == DielectricFresnel::schlick;
            break;
        case MaterialType::light:
            out.kind = MaterialKind::light;
            out.emission = m.radiance;
            break;
        case MaterialType::null:
            out.kind = MaterialKind::null;
            break;
        default:
            flatten(i, 1, lobes, out.emission);
            set_probabilities(lobes);
        }
        scene_.materials.add(std::move(out), lobes);
    }
    used_.assign(scene_.materials.size(), false);
}

} // namespace glimmer
