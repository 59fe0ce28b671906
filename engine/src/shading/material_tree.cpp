// SPDX-License-Identifier: GPL-3.0-or-later
#include "shading/material_tree.h"

#include "base/error.h"
#include "shading/material_schema.h"
#include "shading/program.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace glimmer {

namespace {

/// A width that varies stays above this, so that a surface is either a mirror or none.
constexpr float kLeastVaryingAlpha = 1e-3f;
constexpr float kLeastPositive = 1e-3f;

Brushed to_brushed(const MaterialDescription &m, const Conductor &metal) {
    return {metal, std::clamp(m.alpha / m.aspect, kSmoothAlpha, 1.0f),
            std::clamp(m.alpha * m.aspect, kSmoothAlpha, 1.0f), Vec3f(m.tangent.r, m.tangent.g, m.tangent.b),
            m.rotation};
}

/// A material that is a single lobe.
Lobe to_lobe(const MaterialDescription &m) {
    switch (m.type) {
    case MaterialType::lambert:
        if (m.roughness > 0)
            return OrenNayar{m.albedo, m.roughness, m.facets != FacetScattering::single,
                             m.facets == FacetScattering::tinted};
        return Lambert{m.albedo};
    case MaterialType::mirror:
        return Mirror{m.reflectance};
    case MaterialType::conductor: {
        const Conductor metal{m.alpha,     m.alternative == 2,
                              m.eta,       m.k,
                              m.f0,        m.masking,
                              m.f90,       m.f82,
                              m.curve_ior, m.facets == FacetScattering::multiple};
        if (m.aspect != 1 && !is_specular(metal))
            return to_brushed(m, metal);
        return metal;
    }
    case MaterialType::report_metal:
        return BaselineMetal{m.albedo, m.f0, m.alpha};
    case MaterialType::glass:
        return Dielectric{
            m.ior,        m.alpha,        m.fresnel == DielectricFresnel::schlick, m.lobes == DielectricLobes::both,
            m.reflection, m.transmission, m.facets == FacetScattering::multiple,   m.masking};
    case MaterialType::translucent:
        return Translucent{m.albedo};
    case MaterialType::burley:
        return Burley{m.albedo, m.roughness, m.part};
    case MaterialType::sheen:
        return Sheen{m.color, m.roughness, m.model};
    case MaterialType::subsurface:
    case MaterialType::mix:
    case MaterialType::add:
    case MaterialType::layer:
    case MaterialType::transparent:
    case MaterialType::light:
    case MaterialType::null:
    case MaterialType::holdout:
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
    float high() const { return float(std::min(info.high, double(kMostOfPrograms))); }

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

/// Where a part of a tree stands in the sum.
struct Standing {
    float weight = 1;
    uint32_t above = 0; ///< see WeightedLobe
    float cover = 1;

    Standing times(float share) const { return {weight * share, above, cover * share}; }
};

/// The bits of the lobes from one on.
uint32_t lobes_from(size_t begin, const FlatMaterial &out, const MaterialDescription &layer) {
    uint32_t bits = 0;
    for (size_t i = begin; i < out.lobes.size(); ++i) {
        if (i >= WeightedLobe::kMostAbove)
            fail_argument("material \"" + layer.label + "\": a layer stands after more than " +
                          std::to_string(WeightedLobe::kMostAbove) + " parts");
        bits |= 1u << i;
    }
    return bits;
}

/// Channels whose light leaves where it enters become a diffuse lobe.
void add_subsurface(const MaterialDescription &m, const Standing &standing, FlatMaterial &out) {
    constexpr float kLeastIor = 1.01f, kMostIor = 3.8f;
    Subsurface walk{m.albedo,      m.radius, m.color, m.anisotropy, std::clamp(m.entry_ior, kLeastIor, kMostIor),
                    m.entry_alpha, m.walk,   m.entry, m.boundary};
    Rgb diffuse;
    for (int c = 0; c < 3; ++c)
        if (!(m.radius[c] >= kLeastSubsurfaceRadius)) {
            diffuse[c] = m.albedo[c] * m.color[c];
            walk.albedo[c] = 0;
            walk.radius[c] = 1;
        }
    const auto push = [&](const Lobe &lobe) {
        out.lobes.push_back({lobe, standing.weight, 0, standing.above, standing.cover});
    };
    if (!is_black(diffuse)) {
        if (m.boundary == SubsurfaceBoundary::burley)
            push(Burley{diffuse, 0, BurleyPart::base});
        else
            push(Lambert{diffuse});
    }
    if (!is_black(walk.albedo) || is_black(diffuse))
        push(walk);
}

void add_leaves(std::span<const MaterialDescription> nodes, uint32_t index, const Standing &standing,
                const ProgramOutputs *outputs, FlatMaterial &out) {
    const float weight = standing.weight;
    const MaterialDescription *node = &nodes[index];
    MaterialDescription own;
    if (outputs && !outputs->bindings[index].empty()) {
        own = *node;
        for (const ParameterBinding &b : outputs->bindings[index])
            if (!b.is_normal())
                std::visit(Put{kParameters[b.row].info, (*outputs)(b), own}, kParameters[b.row].member);
        node = &own;
    }
    const MaterialDescription &m = *node;
    out.emission += m.emission * weight;
    if (!(weight > 0))
        return;
    switch (m.type) {
    case MaterialType::mix:
        add_leaves(nodes, m.a, standing.times(m.weight), outputs, out);
        add_leaves(nodes, m.b, standing.times(1 - m.weight), outputs, out);
        break;
    case MaterialType::add:
        add_leaves(nodes, m.a, standing, outputs, out);
        add_leaves(nodes, m.b, standing, outputs, out);
        break;
    case MaterialType::layer: {
        const size_t begin = out.lobes.size();
        add_leaves(nodes, m.a, {weight * m.weight, standing.above, m.weight}, outputs, out);
        const uint32_t top = lobes_from(begin, out, m);
        add_leaves(nodes, m.b, {weight, standing.above | top, standing.cover}, outputs, out);
        break;
    }
    case MaterialType::light:
        out.emission += m.radiance * weight;
        break;
    case MaterialType::null:
        out.transparency += Rgb(weight);
        break;
    case MaterialType::holdout:
        out.holdout += weight;
        break;
    case MaterialType::transparent:
        out.transparency += m.transmittance * weight;
        break;
    case MaterialType::subsurface:
        add_subsurface(m, standing, out);
        break;
    default:
        out.lobes.push_back({to_lobe(m), weight, 0, standing.above, standing.cover});
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
    out.holdout = 0;
    add_leaves(nodes, index, {}, outputs, out);
    if (interior_ior(out.lobes) > 0 && !is_black(out.transparency)) { // what goes straight through enters the body, too
        out.lobes.push_back({Transparent{out.transparency}, 1, 0});
        out.transparency = {};
    }
}

bool varies(std::span<const MaterialDescription> nodes, uint32_t index) {
    const MaterialDescription &m = nodes[index];
    const bool is_brushed = m.type == MaterialType::conductor && m.aspect != 1; // by its tangent
    return !m.bindings.empty() || is_brushed || (has_parts(m) && (varies(nodes, m.a) || varies(nodes, m.b)));
}

} // namespace glimmer
