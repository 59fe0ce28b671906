// SPDX-License-Identifier: GPL-3.0-or-later
// The one table of passes (AOVs): what --list-aovs prints, what the film keeps of a sample and how, how pictures are
// merged, and what the add-on registers. A new pass is a row here and a field of FilmSample.
#pragma once

#include "film/sample.h"
#include "glimmer.h"

#include <array>
#include <cstring>

namespace glimmer {

struct Pass {
    glimmer_pass_info_t info;
    /// Writes what a sample adds to the sums of the pass, a value a channel. Null where the film makes the pass from
    /// its replicates of the radiance.
    void (*value)(const FilmSample &sample, float *channels) = nullptr;
};

namespace detail {

inline constexpr size_t kMaxPassChannels = 4;

template <class Value>
void put(const Value &v, float *channels) {
    if constexpr (std::is_same_v<Value, Rgb>)
        channels[0] = v.r, channels[1] = v.g, channels[2] = v.b;
    else if constexpr (std::is_same_v<Value, Vec3f>)
        channels[0] = v.x, channels[1] = v.y, channels[2] = v.z;
    else
        channels[0] = float(v);
}
template <auto Member>
void pass_value(const FilmSample &sample, float *channels) {
    put(sample.*Member, channels);
}
template <auto Member>
void more_value(const FilmSample &sample, float *channels) {
    put(sample.more->*Member, channels);
}
/// Sums are of what surfaces take up; the pass shows what is left.
template <auto Member>
void rest_value(const FilmSample &sample, float *channels) {
    channels[0] = 1 - sample.more->*Member;
}
template <size_t Group>
constexpr Pass light_group(const char *name) {
    return {{name, "RGB", "light from the lights of the group", GLIMMER_RULE_MEAN},
            [](const FilmSample &sample, float *channels) { put(sample.more->light_groups[Group], channels); }};
}
template <size_t Number>
constexpr Pass aov(const char *name) {
    return {{name, "RGBA", "what materials give, and the part of the pixel where they do", GLIMMER_RULE_MEAN},
            [](const FilmSample &sample, float *channels) {
                const AovValue &value = sample.more->aovs[Number];
                put(value.color, channels);
                channels[3] = value.part;
            }};
}
/// The film adds covers up by itself.
inline void no_value(const FilmSample &, float *) {}
inline constexpr const char *kMatteChannels = "0123456789abcdefghijklmnopqrstuv"; // numbers even, parts odd

} // namespace detail

/// By glimmer_pass.
inline constexpr std::array<Pass, GLIMMER_PASS_COUNT> kPasses{{
    {{"combined", "RGB", "radiance", GLIMMER_RULE_MEAN}},
    {{"stderr", "RGB", "standard error of the combined mean", GLIMMER_RULE_STANDARD_ERROR}},
    {{"albedo", "RGB", "albedo of the first surface that is not a mirror or glass", GLIMMER_RULE_MEAN},
     detail::pass_value<&FilmSample::albedo>},
    {{"normal", "XYZ", "world shading normal of the first surface", GLIMMER_RULE_MEAN},
     detail::pass_value<&FilmSample::normal>},
    {{"depth", "Z", "distance along the camera's axis to the first surface, 1e10 where there is none",
      GLIMMER_RULE_MEAN_OF_HITS},
     detail::pass_value<&FilmSample::depth>},
    {{"emission", "RGB", "light seen directly, also through mirrors and glass", GLIMMER_RULE_MEAN},
     detail::pass_value<&FilmSample::emission>},
    {{"direct", "RGB", "light scattered once, by a surface", GLIMMER_RULE_MEAN},
     detail::pass_value<&FilmSample::direct>},
    {{"indirect", "RGB", "light scattered more than once, first by a surface as seen from the camera",
      GLIMMER_RULE_MEAN},
     detail::pass_value<&FilmSample::indirect>},
    {{"fog", "RGB", "light that the fog scattered to the camera", GLIMMER_RULE_MEAN},
     detail::pass_value<&FilmSample::medium>},
    {{"object_index", "X", "index of the object at the pixel's first sample, 0 if none", GLIMMER_RULE_FIRST},
     detail::pass_value<&FilmSample::object_index>},
    {{"material_index", "X", "1 + the material at the pixel's first sample, 0 if none", GLIMMER_RULE_FIRST},
     detail::pass_value<&FilmSample::material_index>},
    {{"sample_count", "X", "samples of the pixel", GLIMMER_RULE_COUNT}},
    {{"alpha", "A", "part of the pixel that is not empty: environment of a transparent film, holdouts",
      GLIMMER_RULE_MEAN},
     detail::rest_value<&PassSample::transparency>},
    {{"position", "XYZ", "position of the first surface at the pixel's first sample, 0 if none", GLIMMER_RULE_FIRST},
     detail::more_value<&PassSample::position>},
    {{"uv", "UVA", "texture coordinates of the first surface, and 1 where there is one", GLIMMER_RULE_MEAN},
     detail::more_value<&PassSample::uv>},
    {{"mist", "Z", "0 near the camera to 1 far from it, as the film's mist says", GLIMMER_RULE_MEAN},
     detail::rest_value<&PassSample::clearness>},
    {{"emit", "RGB", "light of surfaces, lamps and media seen directly", GLIMMER_RULE_MEAN},
     detail::more_value<&PassSample::emit>},
    {{"environment", "RGB", "environment seen directly, also where the film is transparent", GLIMMER_RULE_MEAN},
     detail::more_value<&PassSample::environment>},
    {{"diffuse_direct", "RGB", "light from lights that a surface reflects diffusely", GLIMMER_RULE_MEAN},
     detail::more_value<&PassSample::diffuse_direct>},
    {{"diffuse_indirect", "RGB", "other light that a surface reflects diffusely", GLIMMER_RULE_MEAN},
     detail::more_value<&PassSample::diffuse_indirect>},
    {{"diffuse_color", "RGB", "albedo of what reflects diffusely", GLIMMER_RULE_MEAN},
     detail::more_value<&PassSample::diffuse_color>},
    {{"glossy_direct", "RGB", "light from lights that a surface reflects otherwise", GLIMMER_RULE_MEAN},
     detail::more_value<&PassSample::glossy_direct>},
    {{"glossy_indirect", "RGB", "other light that a surface reflects otherwise", GLIMMER_RULE_MEAN},
     detail::more_value<&PassSample::glossy_indirect>},
    {{"glossy_color", "RGB", "albedo of what reflects otherwise", GLIMMER_RULE_MEAN},
     detail::more_value<&PassSample::glossy_color>},
    {{"transmission_direct", "RGB", "light from lights that a surface sends to its other side", GLIMMER_RULE_MEAN},
     detail::more_value<&PassSample::transmission_direct>},
    {{"transmission_indirect", "RGB", "other light that a surface sends to its other side", GLIMMER_RULE_MEAN},
     detail::more_value<&PassSample::transmission_indirect>},
    {{"transmission_color", "RGB", "albedo of what sends light to the other side", GLIMMER_RULE_MEAN},
     detail::more_value<&PassSample::transmission_color>},
    {{"volume_direct", "RGB", "light from lights that a medium scatters to the camera", GLIMMER_RULE_MEAN},
     detail::more_value<&PassSample::volume_direct>},
    {{"volume_indirect", "RGB", "other light that a medium scatters to the camera", GLIMMER_RULE_MEAN},
     detail::more_value<&PassSample::volume_indirect>},
    {{"object_matte", detail::kMatteChannels, "numbers and parts of the pixel of the objects seen", GLIMMER_RULE_MATTE},
     detail::no_value},
    {{"material_matte", detail::kMatteChannels, "the same of 1 + the materials", GLIMMER_RULE_MATTE}, detail::no_value},
    detail::light_group<0>("light_group_1"),
    detail::light_group<1>("light_group_2"),
    detail::light_group<2>("light_group_3"),
    detail::light_group<3>("light_group_4"),
    detail::light_group<4>("light_group_5"),
    detail::light_group<5>("light_group_6"),
    detail::light_group<6>("light_group_7"),
    detail::light_group<7>("light_group_8"),
    detail::light_group<8>("light_group_9"),
    detail::light_group<9>("light_group_10"),
    detail::light_group<10>("light_group_11"),
    detail::light_group<11>("light_group_12"),
    detail::light_group<12>("light_group_13"),
    detail::light_group<13>("light_group_14"),
    detail::light_group<14>("light_group_15"),
    detail::light_group<15>("light_group_16"),
    detail::aov<0>("aov_1"),
    detail::aov<1>("aov_2"),
    detail::aov<2>("aov_3"),
    detail::aov<3>("aov_4"),
    detail::aov<4>("aov_5"),
    detail::aov<5>("aov_6"),
    detail::aov<6>("aov_7"),
    detail::aov<7>("aov_8"),
    {{"ambient_occlusion", "RGB", "part of the directions above a surface where nothing is near", GLIMMER_RULE_MEAN},
     detail::more_value<&PassSample::ambient_occlusion>},
}};

/// Passes as a set of bits.
using PassBits = uint64_t;
constexpr PassBits bit_of(uint32_t pass) {
    return PassBits(1) << pass;
}
/// Those that are made from a PassSample, and of them those of light by group.
inline constexpr PassBits kPassesOfMore = bit_of(GLIMMER_PASS_COUNT) - bit_of(GLIMMER_PASS_ALPHA);
inline constexpr PassBits kLightGroupPasses = bit_of(GLIMMER_PASS_AOV) - bit_of(GLIMMER_PASS_LIGHT_GROUP);

/// Those of light, which is a sum over all that a sample has met.
inline constexpr PassBits kLightPasses = [] {
    PassBits passes = kLightGroupPasses;
    for (const glimmer_pass pass :
         {GLIMMER_PASS_EMISSION, GLIMMER_PASS_DIRECT, GLIMMER_PASS_INDIRECT, GLIMMER_PASS_FOG, GLIMMER_PASS_EMIT,
          GLIMMER_PASS_ENVIRONMENT, GLIMMER_PASS_DIFFUSE_DIRECT, GLIMMER_PASS_DIFFUSE_INDIRECT,
          GLIMMER_PASS_GLOSSY_DIRECT, GLIMMER_PASS_GLOSSY_INDIRECT, GLIMMER_PASS_TRANSMISSION_DIRECT,
          GLIMMER_PASS_TRANSMISSION_INDIRECT, GLIMMER_PASS_VOLUME_DIRECT, GLIMMER_PASS_VOLUME_INDIRECT})
        passes |= bit_of(pass);
    return passes;
}();

inline size_t pass_channels(glimmer_pass pass) {
    return std::strlen(kPasses[size_t(pass)].info.channels);
}

/// Whether every film has the pass, asked for or not.
inline bool is_always_there(glimmer_pass pass) {
    return !kPasses[size_t(pass)].value;
}

} // namespace glimmer
