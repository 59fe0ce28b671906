// SPDX-License-Identifier: GPL-3.0-or-later
// Materials: mixes are flattened into weighted lobes.
#include "base/error.h"
#include "scene/builder.h"

#include <algorithm>
#include <stdexcept>

namespace glimmer {

namespace {

/// A material that is a single lobe.
Lobe to_lobe(const MaterialDescription &m) {
    switch (m.type) {
    case MaterialType::lambert:
        if (m.roughness > 0)
            return OrenNayar{m.albedo, m.roughness, m.facets == FacetScattering::multiple};
        return Lambert{m.albedo};
    case MaterialType::mirror:
        return Mirror{m.reflectance};
    case MaterialType::conductor:
        return Conductor{m.alpha, m.alternative == 2, m.eta, m.k, m.f0, m.masking, m.f90};
    case MaterialType::report_metal:
        return BaselineMetal{m.albedo, m.f0, m.alpha};
    case MaterialType::glass:
        return Dielectric{
            m.ior,        m.alpha,       m.fresnel == DielectricFresnel::schlick, m.lobes == DielectricLobes::both,
            m.reflection, m.transmission};
    case MaterialType::translucent:
        return Translucent{m.albedo};
    case MaterialType::mix:
    case MaterialType::add:
    case MaterialType::transparent:
    case MaterialType::light:
    case MaterialType::null:
    case MaterialType::count:
        break;
    }
    throw std::logic_error("material \"" + m.label + "\" is no lobe");
}

} // namespace

void SceneBuilder::flatten(uint32_t index, float weight, std::vector<WeightedLobe> &lobes, Material &out) const {
    const MaterialDescription &m = description_.materials[index];
    out.emission += m.emission * weight;
    if (!(weight > 0))
        return;
    switch (m.type) {
    case MaterialType::mix:
        flatten(m.a, weight * m.weight, lobes, out);
        flatten(m.b, weight * (1 - m.weight), lobes, out);
        break;
    case MaterialType::add:
        flatten(m.a, weight, lobes, out);
        flatten(m.b, weight, lobes, out);
        break;
    case MaterialType::light:
        out.emission += m.radiance * weight;
        break;
    case MaterialType::null:
        out.transparency += Rgb(weight);
        break;
    case MaterialType::transparent:
        out.transparency += m.transmittance * weight;
        break;
    default:
        lobes.push_back({to_lobe(m), weight, 0});
    }
}

void SceneBuilder::build_materials() {
    for (uint32_t i = 0; i < description_.materials.size(); ++i) {
        Material out;
        out.name = description_.materials[i].label;
        out.null = description_.materials[i].type == MaterialType::null;
        std::vector<WeightedLobe> lobes;
        if (!out.null)
            flatten(i, 1, lobes, out);
        const bool bounds_interior = std::ranges::any_of(
            lobes, [](const WeightedLobe &l) { return std::holds_alternative<Dielectric>(l.lobe); });
        if (bounds_interior && !is_black(out.transparency)) { // what goes straight through enters the body, too
            lobes.push_back({Transparent{out.transparency}, 1, 0});
            out.transparency = {};
        }
        set_probabilities(lobes);
        scene_.materials.add(std::move(out), lobes);
    }
    used_.assign(scene_.materials.size(), false);
}

} // namespace glimmer
