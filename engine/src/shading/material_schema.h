// SPDX-License-Identifier: GPL-3.0-or-later
// The one table of what materials there are and which parameters they have. The C API checks by it and exports it; the
// command reads scene files by it, the add-on fills descriptions and writes scene files by it, and the tables of
// SCENE_FORMAT.md are tested against it. A new kind of material is a row or two here, a closure in bsdf/, its line in
// scene/build_materials.cpp, and the dataclass and the node that use it in the add-on.
#pragma once

#include "glimmer.h"
#include "shading/material_description.h"

#include <array>
#include <limits>
#include <span>
#include <variant>

namespace glimmer {

/// By MaterialType.
inline constexpr std::array kMaterials = std::to_array<glimmer_material_info_t>({
    {"lambert", 1, "a diffuse surface"},
    {"mirror", 1, "a perfect mirror"},
    {"conductor", 1, "a rough metal: GGX, of a complex index of refraction or of two reflectances"},
    {"glass", 1, "the boundary of a dielectric: of a body, if closed; nested glass by containment"},
    {"report_metal", 1, "the student report's sum of a diffuse and a metallic lobe as printed: not energy conserving"},
    {"mix", 1, "a share of one material, the rest of another"},
    {"light", 1, "an opaque black surface of constant outgoing radiance on both sides"},
    {"null", 1, "not there; as a part, straight through"},
    {"add", 1, "two materials on top of each other, each at full strength"},
    {"transparent", 1, "a part of light goes straight through, shadow rays included; with glass it enters the body"},
    {"translucent", 1, "diffuse transmission: a diffuse lobe on the other side"},
    {"burley", 1, "Disney's diffuse surface (Burley 2012): not energy conserving"},
    {"sheen", 1, "cloth's shine towards grazing angles"},
    {"layer", 1, "a material on top of another, which gets what the upper one leaves to it"},
    {"subsurface", 1, "light enters a body, wanders within, and leaves it diffusely elsewhere"},
    {"holdout", 1, "black, and a hole where the camera sees it: 0 in the AOV alpha"},
});
static_assert(kMaterials.size() == size_t(MaterialType::count));

/// A parameter and where its value stands. A word is kept as its number in the enumeration, which lists the same words.
struct ParameterRow {
    MaterialType type;
    glimmer_parameter_info_t info;
    std::variant<float MaterialDescription::*, Rgb MaterialDescription::*, uint32_t MaterialDescription::*,
                 Masking MaterialDescription::*, DielectricFresnel MaterialDescription::*,
                 DielectricLobes MaterialDescription::*, FacetScattering MaterialDescription::*,
                 SheenModel MaterialDescription::*, BurleyPart MaterialDescription::*,
                 SubsurfaceModel MaterialDescription::*, SubsurfaceEntry MaterialDescription::*,
                 SubsurfaceBoundary MaterialDescription::*>
        member;
};

namespace schema {

/// What the numbers of a parameter may be.
struct Range {
    double low, high;
    bool above_low = false;
};
inline constexpr Range kUnit{0, 1};
inline constexpr Range kDirection{-1, 1};
inline constexpr Range kCosine{-0.99, 0.99};
inline constexpr Range kNonNegative{0, std::numeric_limits<double>::infinity()};
inline constexpr Range kPositive{0, std::numeric_limits<double>::infinity(), true};

using D = MaterialDescription;
using T = MaterialType;

constexpr ParameterRow row(T type, const char *key, glimmer_parameter_kind kind, const Range &range, bool required,
                           const char *help, decltype(ParameterRow::member) member) {
    glimmer_parameter_info_t info{};
    info.type = kMaterials[size_t(type)].type;
    info.key = key;
    info.kind = kind;
    info.low = range.low;
    info.high = range.high;
    info.above_low = range.above_low;
    info.required = required;
    info.words = info.noun = "";
    info.help = help;
    return {type, info, member};
}

constexpr ParameterRow number(T type, const char *key, float D::*member, const Range &range, const char *help) {
    return row(type, key, GLIMMER_NUMBER, range, true, help, member);
}
constexpr ParameterRow color(T type, const char *key, Rgb D::*member, const Range &range, const char *help) {
    return row(type, key, GLIMMER_COLOR, range, true, help, member);
}
constexpr ParameterRow material(T type, const char *key, uint32_t D::*member, const char *help) {
    return row(type, key, GLIMMER_MATERIAL, {}, true, help, member);
}
template <class Words>
constexpr ParameterRow word(T type, const char *key, Words D::*member, const char *words, const char *noun,
                            const char *help) {
    ParameterRow r = row(type, key, GLIMMER_WORD, {}, false, help, member);
    r.info.words = words;
    r.info.noun = noun;
    return r;
}
/// The same, but need not be given; then it is `value`.
constexpr ParameterRow optional(ParameterRow r, float value) {
    r.info.required = false;
    r.info.value = value;
    return r;
}
/// The same, as one of the parameters of the type's n-th alternative.
constexpr ParameterRow alternative(uint32_t n, ParameterRow r) {
    r.info.alternative = n;
    return r;
}
constexpr ParameterRow emission(T type) {
    return optional(color(type, "emission", &D::emission, kNonNegative,
                          "radiance on both sides, added to what the surface scatters"),
                    0);
}

} // namespace schema

/// By type, in the order in which messages list them.
inline constexpr std::array kParameters = [] {
    using namespace schema;
    return std::to_array<ParameterRow>({
        color(T::lambert, "albedo", &D::albedo, kUnit, ""),
        optional(number(T::lambert, "roughness", &D::roughness, kUnit, "of Oren and Nayar, in Fujii's form"), 0),
        word(T::lambert, "facets", &D::facets, "single multiple tinted", "facet model",
             "whether rough facets send light on to each other; tinted: that light has the albedo once more"),
        emission(T::lambert),

        color(T::mirror, "reflectance", &D::reflectance, kUnit, ""),
        emission(T::mirror),

        number(T::conductor, "alpha", &D::alpha, kUnit, "GGX width, Blender's roughness squared; below 1e-4 a mirror"),
        alternative(1, color(T::conductor, "eta", &D::eta, kPositive, "index of refraction: exact Fresnel equations")),
        alternative(1, color(T::conductor, "k", &D::k, kNonNegative, "extinction coefficient")),
        alternative(2, color(T::conductor, "f0", &D::f0, kUnit, "reflectance at normal incidence: Schlick's")),
        alternative(2, optional(color(T::conductor, "f90", &D::f90, kUnit, "reflectance at grazing"), 1)),
        alternative(2, optional(color(T::conductor, "f82", &D::f82, kUnit, "times Schlick's curve at 82 degrees"), 1)),
        alternative(2, optional(number(T::conductor, "ior", &D::curve_ior, kNonNegative,
                                       "from f0 to f90 by the curve of this index; 0: Schlick's"),
                                0)),
        word(T::conductor, "masking", &D::masking, "smith smith_separable schlick_ggx", "masking function",
             "height-correlated Smith; separable Smith; the student report's, k = alpha/2"),
        optional(number(T::conductor, "aspect", &D::aspect, kPositive,
                        "alpha across the tangent is alpha times this, along it alpha over this"),
                 1),
        optional(color(T::conductor, "tangent", &D::tangent, kDirection, "direction in the world; 0: any"), 0),
        optional(number(T::conductor, "rotation", &D::rotation, kUnit, "of the tangent about the normal, in turns"), 0),
        word(T::conductor, "facets", &D::facets, "single multiple", "facet model",
             "whether facets send light on to each other"),
        emission(T::conductor),

        number(T::glass, "ior", &D::ior, kPositive, "index of refraction; radiance scales with its square"),
        word(T::glass, "fresnel", &D::fresnel, "exact schlick", "Fresnel function", ""),
        optional(number(T::glass, "alpha", &D::alpha, kUnit, "GGX width; below 1e-4 smooth"), 0),
        optional(color(T::glass, "reflection", &D::reflection, kUnit, "colour of what is reflected"), 1),
        optional(color(T::glass, "transmission", &D::transmission, kUnit, "and of what is transmitted, each time"), 1),
        word(T::glass, "lobes", &D::lobes, "both refraction", "choice of lobes",
             "refraction alone refracts all light that can be refracted, and reflects none"),
        word(T::glass, "facets", &D::facets, "single multiple", "facet model",
             "whether facets send light on to each other"),
        word(T::glass, "masking", &D::masking, "smith smith_separable", "masking function", ""),
        emission(T::glass),

        color(T::report_metal, "albedo", &D::albedo, kUnit, ""),
        color(T::report_metal, "f0", &D::f0, kUnit, "reflectance at normal incidence"),
        number(T::report_metal, "alpha", &D::alpha, kUnit, "GGX width"),
        emission(T::report_metal),

        number(T::mix, "weight", &D::weight, kUnit, "of a; the rest is b"),
        material(T::mix, "a", &D::a, ""),
        material(T::mix, "b", &D::b, ""),
        emission(T::mix),

        color(T::light, "radiance", &D::radiance, kNonNegative, ""),

        material(T::add, "a", &D::a, ""),
        material(T::add, "b", &D::b, ""),
        emission(T::add),

        color(T::transparent, "transmittance", &D::transmittance, kUnit, ""),
        emission(T::transparent),
        emission(T::holdout),

        color(T::translucent, "albedo", &D::albedo, kUnit, ""),
        emission(T::translucent),

        color(T::burley, "albedo", &D::albedo, kUnit, ""),
        number(T::burley, "roughness", &D::roughness, kUnit, ""),
        word(T::burley, "part", &D::part, "whole base retro", "part",
             "base: what knows no roughness; retro: what rough surfaces send back"),
        emission(T::burley),

        color(T::sheen, "color", &D::color, kUnit, ""),
        optional(number(T::sheen, "roughness", &D::roughness, kUnit, "of fibers and velvet"), 0),
        word(T::sheen, "model", &D::model, "fibers schlick velvet", "model of sheen",
             "Zeltner, Burley, Chiang 2022; Schlick's weight; Ashikhmin, Premoze, Shirley 2000"),
        emission(T::sheen),

        number(T::layer, "weight", &D::weight, kUnit, "part of b that a is above of"),
        material(T::layer, "a", &D::a, ""),
        material(T::layer, "b", &D::b, ""),
        emission(T::layer),

        color(T::subsurface, "albedo", &D::albedo, kUnit, "of a half-space"),
        color(T::subsurface, "radius", &D::radius, kNonNegative, "lengths; a channel of less than 1e-8 is diffuse"),
        word(T::subsurface, "model", &D::walk, "random_walk fixed_radius skin", "model",
             "the radius is the mean free path; 4 pi of them; or that of a diffusion dipole of the ior"),
        word(T::subsurface, "entry", &D::entry, "refracted diffuse both", "kind of entry",
             "by facets of ior and alpha; by cosine; half by each"),
        optional(number(T::subsurface, "ior", &D::entry_ior, kPositive, ""), 1.4f),
        optional(number(T::subsurface, "alpha", &D::entry_alpha, kUnit, "GGX width of the facets"), 1),
        optional(number(T::subsurface, "anisotropy", &D::anisotropy, kCosine, "mean cosine of scattering"), 0),
        optional(color(T::subsurface, "color", &D::color, kUnit, "factor of what comes out"), 1),
        word(T::subsurface, "boundary", &D::boundary, "lambert burley", "boundary",
             "burley: less light at grazing angles, in and out"),
        emission(T::subsurface),
    });
}();

inline std::span<const ParameterRow> parameters_of(MaterialType type) {
    size_t begin = 0, end = kParameters.size();
    while (begin < end && kParameters[begin].type != type)
        ++begin;
    while (end > begin && kParameters[end - 1].type != type)
        --end;
    return std::span(kParameters).subspan(begin, end - begin);
}

} // namespace glimmer
