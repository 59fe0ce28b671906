// SPDX-License-Identifier: GPL-3.0-or-later
#include "parts.h"

#include <algorithm>

namespace glimmer {
namespace {

constexpr std::string_view kNames[] = {"point", "spot", "sun", "area"};
constexpr glimmer_light_type kTypes[] = {GLIMMER_POINT, GLIMMER_SPOT, GLIMMER_SUN, GLIMMER_AREA};
constexpr Range kAngle{0, 180};

template <class From, class To>
void copy(const From &from, To &to) {
    std::copy(from.begin(), from.end(), to);
}

void read_point(const Value &value, glimmer_light_desc &desc) {
    copy(value.at("position").numbers<3>(), desc.position);
    copy(value.at("intensity").color(kNonNegative), desc.color);
    if (const auto radius = value.find("radius"))
        desc.radius = radius->number(kNonNegative);
}

void read_area(const Value &value, glimmer_light_desc &desc) {
    constexpr std::string_view shapes[] = {"rectangle", "ellipse"};
    copy(value.at("to_world").matrix(), desc.to_world);
    copy(value.at("size").numbers<2>(kPositive), desc.size);
    copy(value.at("radiance").color(kNonNegative), desc.color);
    if (const auto shape = value.find("shape"))
        desc.ellipse = one_of(*shape, "a shape", "shapes", shapes) == 1;
}

} // namespace

void read_light(const Value &value, glimmer_scene *scene) {
    value.expect_table();
    const std::string name = value.path();
    glimmer_light_desc desc;
    glimmer_light_init(&desc);
    desc.name = name.c_str();
    desc.type = kTypes[one_of(value.at("type"), "a light type", "light types", kNames)];
    switch (desc.type) {
    case GLIMMER_POINT:
        value.expect_object({"type", "position", "intensity", "radius"});
        read_point(value, desc);
        break;
    case GLIMMER_SPOT:
        value.expect_object({"type", "position", "intensity", "radius", "direction", "angle", "blend"});
        read_point(value, desc);
        copy(value.at("direction").direction(), desc.direction);
        desc.angle = value.at("angle").number({.low = 0, .high = 180, .open_low = true});
        desc.blend = value.has("blend") ? value.at("blend").number(kUnit) : 0;
        break;
    case GLIMMER_SUN:
        value.expect_object({"type", "direction", "irradiance", "angle"});
        copy(value.at("direction").direction(), desc.direction);
        copy(value.at("irradiance").color(kNonNegative), desc.color);
        desc.angle = value.has("angle") ? value.at("angle").number(kAngle) : 0;
        break;
    case GLIMMER_AREA:
        value.expect_object({"type", "to_world", "size", "shape", "radiance"});
        read_area(value, desc);
        break;
    }
    check(glimmer_scene_add_light(scene, &desc), value.where());
}

} // namespace glimmer
