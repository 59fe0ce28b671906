// SPDX-License-Identifier: GPL-3.0-or-later
// A scene of five emissive spheres in a medium, and nothing else.
#pragma once

#include "empty_scene.h"

namespace glimmer {

inline constexpr uint32_t kMoons = 5;

inline SceneDescription five_moons(uint32_t width, uint32_t height) {
    SceneDescription scene = empty_scene();
    for (uint32_t i = 0; i < kMoons; ++i)
        add_moon(scene, 1.25f * float(i), {-16.0 + 8 * i, 4 - 3.0 * (i % 3), -30 - 3.0 * (i % 2)}, 0.8 + 0.3 * i);
    scene.medium = MediumDescription{{0.004, 0.004, 0.004}, {0.036, 0.036, 0.036}, 0, {}};
    scene.film->width = width;
    scene.film->height = height;
    return scene;
}

} // namespace glimmer
