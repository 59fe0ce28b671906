// SPDX-License-Identifier: GPL-3.0-or-later
// Five moons and nothing but fog.
#pragma once

#include "empty_scene.h"

#include <cmath>

namespace glimmer {

inline constexpr uint32_t kMoons = 5;

inline SceneDescription five_moons(uint32_t width, uint32_t height) {
    SceneDescription scene = empty_scene();
    for (uint32_t i = 0; i < kMoons; ++i) {
        MaterialDescription material;
        glimmer_material_init(&material);
        material.type = GLIMMER_LIGHT;
        for (size_t c = 0; c < 3; ++c)
            material.color[c] = 20 + 10 * std::cos(1.25f * float(i) + 2 * float(c));
        scene.materials.push_back(material);
        SpheresDescription sphere;
        sphere.centers = {{-16.0 + 8 * i, 4 - 3.0 * (i % 3), -30 - 3.0 * (i % 2)}};
        sphere.radii = {0.8 + 0.3 * i};
        sphere.material = i;
        scene.spheres.push_back(sphere);
    }
    scene.medium = MediumDescription{{0.004, 0.004, 0.004}, {0.036, 0.036, 0.036}, 0};
    scene.film->width = width;
    scene.film->height = height;
    return scene;
}

} // namespace glimmer
