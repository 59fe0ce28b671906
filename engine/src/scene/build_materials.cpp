// SPDX-License-Identifier: GPL-3.0-or-later
// Materials: mixes are flattened into weighted lobes.
#include "base/error.h"
#include "scene/builder.h"

namespace glimmer {

namespace {

Rgb to_rgb(const float (&c)[3]) {
    return {c[0], c[1], c[2]};
}

Masking to_masking(glimmer_masking masking) {
    return masking == GLIMMER_SMITH             ? Masking::Smith
           : masking == GLIMMER_SMITH_SEPARABLE ? Masking::SmithSeparable
                                                : Masking::SchlickGgx;
}

Lobe to_lobe(const MaterialDescription &m) {
    switch (m.type) {
    case GLIMMER_MIRROR:
        return Mirror{to_rgb(m.color)};
    case GLIMMER_CONDUCTOR:
        return Conductor{m.alpha,      m.use_f0 != 0,         to_rgb(m.eta), to_rgb(m.k),
                         to_rgb(m.f0), to_masking(m.masking), to_rgb(m.f90)};
    case GLIMMER_REPORT_METAL:
        return BaselineMetal{to_rgb(m.color), to_rgb(m.f0), m.alpha};
    default:
        return Lambert{to_rgb(m.color)};
    }
}

} // namespace

void SceneBuilder::flatten(uint32_t index, float weight, std::vector<WeightedLobe> &lobes, Rgb &emission) const {
    const MaterialDescription &m = description_.materials[index];
    emission += to_rgb(m.emission) * weight;
    if (m.type == GLIMMER_MIX) {
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
        case GLIMMER_GLASS:
            out.kind = MaterialKind::glass;
            out.ior = m.ior;
            out.schlick = m.schlick_fresnel != 0;
            break;
        case GLIMMER_LIGHT:
            out.kind = MaterialKind::light;
            out.emission = to_rgb(m.color);
            break;
        case GLIMMER_NULL:
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
