// SPDX-License-Identifier: GPL-3.0-or-later
#include "parts.h"

namespace glimmer {

void read_medium(const Value &value, glimmer_scene *scene) {
    value.expect_object({"sigma_a", "sigma_s", "g"});
    const auto sigma = [&](const char *key) {
        const auto found = value.find(key);
        return found ? found->color_double(kNonNegative) : Double3{0, 0, 0};
    };
    const Double3 sigma_a = sigma("sigma_a"), sigma_s = sigma("sigma_s");
    const auto g = value.find("g");
    check(glimmer_scene_set_medium(scene, sigma_a.data(), sigma_s.data(),
                                   g ? g->number({.low = -1, .high = 1, .open_low = true, .open_high = true}) : 0),
          value.where());
}

} // namespace glimmer
