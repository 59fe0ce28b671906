// SPDX-License-Identifier: GPL-3.0-or-later
#include "parts.h"

#include <algorithm>

namespace glimmer {

namespace {

constexpr Range kAnisotropy{.low = -1, .high = 1, .open_low = true, .open_high = true};

Double3 coefficients(const Value &value, const char *key) {
    const auto found = value.find(key);
    return found ? found->color_double(kNonNegative) : Double3{0, 0, 0};
}

double anisotropy(const Value &value) {
    const auto g = value.find("g");
    return g ? g->number(kAnisotropy) : 0;
}

} // namespace

void read_medium(const Value &value, glimmer_scene *scene) {
    value.expect_object({"sigma_a", "sigma_s", "g", "height", "scale_height"});
    const Double3 sigma_a = coefficients(value, "sigma_a"), sigma_s = coefficients(value, "sigma_s");
    check(glimmer_scene_set_medium(scene, sigma_a.data(), sigma_s.data(), anisotropy(value)), value.where());
    const auto scale_height = value.find("scale_height"), height = value.find("height");
    if (height && !scale_height)
        height->fail("goes with scale_height");
    if (scale_height)
        check(glimmer_scene_set_medium_falloff(scene, height ? height->number({}) : 0, scale_height->number(kPositive)),
              value.where());
}

std::optional<Interior> read_interior(const Value &owner, const Programs &programs) {
    const auto value = owner.find("interior");
    if (!value)
        return std::nullopt;
    value->expect_object({"sigma_a", "sigma_s", "g", "emission"});
    Interior out;
    glimmer_medium_init(&out.desc);
    const auto is_bound = [&](const char *key) {
        const auto found = value->find(key);
        if (!found || !is_binding(*found))
            return false;
        const Binding binding = programs.read_binding(*found);
        out.bindings.push_back({key, binding.program, binding.output});
        return true;
    };
    if (!is_bound("sigma_a"))
        std::ranges::copy(coefficients(*value, "sigma_a"), out.desc.sigma_a);
    if (!is_bound("sigma_s"))
        std::ranges::copy(coefficients(*value, "sigma_s"), out.desc.sigma_s);
    if (!is_bound("emission"))
        std::ranges::copy(coefficients(*value, "emission"), out.desc.emission);
    if (!is_bound("g"))
        out.desc.g = anisotropy(*value);
    out.desc.binding_count = out.bindings.size();
    out.desc.bindings = out.bindings.data(); // which a move of the vector keeps
    return out;
}

} // namespace glimmer
