// SPDX-License-Identifier: GPL-3.0-or-later
#include "shading/material_tree.h"

#include "shading/material_schema.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace glimmer {

namespace {

/// A width that varies stays above this, so that a surface is either a mirror or none.
constexpr float kLeastVaryingAlpha = 1e-3f;
constexpr float kLeastPositive = 1e-3f, kMost = 1e30f;

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

/// NaN becomes the lower bound.
float cut(float x, float low, float high) {
    return x > low ? std::min(x, high) : low;
}

/// Puts a value of the place into a material, in the range that the schema allows.
struct Put {
    const glimmer_parameter_info_t &info;
    const Vec3f &value;
    MaterialDescription &out;

    float low() const { return info.above_low ? std::max(float(info.low), kLeastPositive) : float(info.low); }
    float high() const { return float(std::min(info.high, double(kMost))); }

    void operator()(float MaterialDescription::*member) const {
        const float least = member == &MaterialDescription::alpha ? kLeastVaryingAlpha : low();
        out.*member = cut(value.x, least, high());
    }
    void operator()(Rgb MaterialDescription::*member) const {
        out.*member = {cut(value.x, low(), high()), cut(value.y, low(), high()), cut(value.z, low(), high())};
    }
    template <class Other>
    void operator()(Other) const {} // words and parts do not vary
};

void add_leaves(std::span<const MaterialDescription> nodes, uint32_t index, float weight, const ProgramOutputs *outputs,
                FlatMaterial &out) {
    const MaterialDescription *node = &nodes[index];
    MaterialDescription own;
    if (outputs && !outputs->bindings[index].empty()) {
        own = *node;
        for (const ParameterBinding &b : outputs->bindings[index])
            if (b.row != ParameterBinding::kNormal)
                std::visit(Put{kParameters[b.row].info, (*outputs)(b), own}, kParameters[b.row].member);
        node = &own;
    }
    const MaterialDescription &m = *node;
    out.emission += m.emission * weight;
    if (!(weight > 0))
        return;
    switch (m.type) {
    case MaterialType::mix:
        add_leaves(nodes, m.a, weight * m.weight, outputs, out);
        add_leaves(nodes, m.b, weight * (1 - m.weight), outputs, out);
        break;
    case MaterialType::add:
        add_leaves(nodes, m.a, weight, outputs, out);
        add_leaves(nodes, m.b, weight, outputs, out);
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
        out.lobes.push_back({to_lobe(m), weight, 0});
    }
}

} // namespace

float interior_ior(std::span<const WeightedLobe> lobes) {
    float ior = 0;
    for (const WeightedLobe &l : lobes)
        if (const auto *dielectric = std::get_if<Dielectric>(&l.lobe))
            ior = dielectric->ior;
    return ior;
}

void flatten(std::span<const MaterialDescription> nodes, uint32_t index, const ProgramOutputs *outputs,
             FlatMaterial &out) {
    out.lobes.clear();
    out.emission = out.transparency = {};
    add_leaves(nodes, index, 1, outputs, out);
    if (interior_ior(out.lobes) > 0 && !is_black(out.transparency)) { // what goes straight through enters the body, too
        out.lobes.push_back({Transparent{out.transparency}, 1, 0});
        out.transparency = {};
    }
}

bool varies(std::span<const MaterialDescription> nodes, uint32_t index) {
    const MaterialDescription &m = nodes[index];
    const bool has_parts = m.type == MaterialType::mix || m.type == MaterialType::add;
    return !m.bindings.empty() || (has_parts && (varies(nodes, m.a) || varies(nodes, m.b)));
}

} // namespace glimmer
