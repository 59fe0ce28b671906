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
    value.expect_object({"sigma_a", "sigma_s", "g"});
    const Double3 sigma_a = coefficients(value, "sigma_a"), sigma_s = coefficients(value, "sigma_s");
    check(glimmer_scene_set_medium(scene, sigma_a.data(), sigma_s.data(), anisotropy(value)), value.where());
}

std::optional<glimmer_medium_desc> read_interior(const Value &owner) {
    const auto value = owner.find("interior");
    if (!value)
        return std::nullopt;
    value->expect_object({"sigma_a", "sigma_s", "g", "emission"});
    glimmer_medium_desc desc;
    glimmer_medium_init(&desc);
    std::ranges::copy(coefficients(*value, "sigma_a"), desc.sigma_a);
    std::ranges::copy(coefficients(*value, "sigma_s"), desc.sigma_s);
    std::ranges::copy(coefficients(*value, "emission"), desc.emission);
    desc.g = anisotropy(*value);
    return desc;
}

} // namespace glimmer
