// SPDX-License-Identifier: GPL-3.0-or-later
#include "parts.h"

#include <algorithm>

namespace glimmer {
namespace {

constexpr std::string_view kNames[] = {"point", "spot", "sun", "area"};
constexpr glimmer_light_type kTypes[] = {GLIMMER_POINT, GLIMMER_SPOT, GLIMMER_SUN, GLIMMER_AREA};
constexpr Range kAngle{0, 180};
constexpr std::string_view kSunShapes[] = {"cap", "tangent"};

template <class From, class To>
void copy(const From &from, To &to) {
    std::copy(from.begin(), from.end(), to);
}

/// What all types have.
void read_common(const Value &value, glimmer_light_desc &desc) {
    desc.light_group = read_light_group(value);
    if (const auto visible = value.find("visible"))
        desc.visible = read_rays(*visible);
    if (const auto shadows = value.find("shadows"))
        desc.shadows = shadows->boolean();
    if (const auto bounces = value.find("max_bounces"); bounces && !bounces->json().is_null())
        desc.max_bounces = static_cast<uint32_t>(bounces->integer(0, UINT32_MAX));
}

/// The shape at a key: the first, the default, or the second.
bool is_second_shape(const Value &value, std::span<const std::string_view> shapes) {
    const auto shape = value.find("shape");
    return shape && one_of(*shape, "a shape", "shapes", shapes) == 1;
}

void read_point(const Value &value, glimmer_light_desc &desc) {
    copy(value.at("position").numbers<3>(), desc.position);
    copy(value.at("intensity").color(kNonNegative), desc.color);
    if (const auto radius = value.find("radius"))
        desc.radius = radius->number(kNonNegative);
    constexpr std::string_view shapes[] = {"sphere", "disk"};
    desc.disk = is_second_shape(value, shapes);
}

void read_area(const Value &value, glimmer_light_desc &desc) {
    constexpr std::string_view shapes[] = {"rectangle", "ellipse"};
    copy(value.at("to_world").matrix(), desc.to_world);
    copy(value.at("size").numbers<2>(kPositive), desc.size);
    copy(value.at("radiance").color(kNonNegative), desc.color);
    desc.ellipse = is_second_shape(value, shapes);
    if (const auto spread = value.find("spread"))
        desc.spread = spread->number({.low = 0, .high = 180, .open_low = true});
}

void read_profile(const Value &profile, uint32_t light, const Programs &programs, glimmer_scene *scene) {
    profile.expect_object({"factor", "to_world"});
    const Binding binding = programs.read_binding(profile.at("factor"));
    double to_world[16];
    copy(profile.at("to_world").matrix(), to_world);
    check(glimmer_scene_bind_light(scene, light, binding.program, binding.output, to_world), profile.where());
}

} // namespace

uint32_t read_light_group(const Value &owner) {
    const auto group = owner.find("light_group");
    return group ? static_cast<uint32_t>(group->integer(0, GLIMMER_MAX_LIGHT_GROUPS)) : 0;
}

void read_light(const Value &value, uint32_t number, const Programs &programs, glimmer_scene *scene) {
    value.expect_table();
    const std::string name = value.path();
    glimmer_light_desc desc;
    glimmer_light_init(&desc);
    desc.name = name.c_str();
    desc.type = kTypes[one_of(value.at("type"), "a light type", "light types", kNames)];
    switch (desc.type) {
    case GLIMMER_POINT:
        value.expect_object({"type", "position", "intensity", "radius", "shape", "visible", "shadows", "max_bounces",
                             "light_group", "profile"});
        read_point(value, desc);
        break;
    case GLIMMER_SPOT:
        value.expect_object({"type", "position", "intensity", "radius", "direction", "angle", "blend", "times_cosine",
                             "shape", "visible", "shadows", "max_bounces", "light_group", "profile"});
        read_point(value, desc);
        copy(value.at("direction").direction(), desc.direction);
        desc.angle = value.at("angle").number({.low = 0, .high = 180, .open_low = true});
        desc.blend = value.has("blend") ? value.at("blend").number(kUnit) : 0;
        if (const auto cosine = value.find("times_cosine"))
            desc.times_cosine = cosine->boolean();
        break;
    case GLIMMER_SUN:
        value.expect_object({"type", "direction", "irradiance", "angle", "shape", "visible", "shadows", "max_bounces",
                             "light_group", "profile"});
        copy(value.at("direction").direction(), desc.direction);
        copy(value.at("irradiance").color(kNonNegative), desc.color);
        desc.angle = value.has("angle") ? value.at("angle").number(kAngle) : 0;
        desc.disk = is_second_shape(value, kSunShapes);
        break;
    case GLIMMER_AREA:
        value.expect_object({"type", "to_world", "size", "shape", "radiance", "spread", "visible", "shadows",
                             "max_bounces", "light_group", "profile"});
        read_area(value, desc);
        break;
    }
    read_common(value, desc);
    check(glimmer_scene_add_light(scene, &desc), value.where());
    if (const auto profile = value.find("profile"))
        read_profile(*profile, number, programs, scene);
}

} // namespace glimmer
