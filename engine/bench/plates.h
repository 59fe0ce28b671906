// SPDX-License-Identifier: GPL-3.0-or-later
// A field of instanced plates.
#pragma once

#include "empty_scene.h"
#include "inputs.h"

#include <cmath>
#include <memory>
#include <numbers>

namespace glimmer {

/// A hexagonal prism of radius 1.
inline std::shared_ptr<Mesh> plate() {
    auto mesh = std::make_shared<Mesh>();
    for (const float z : {-0.1f, 0.1f})
        for (int i = 0; i < 6; ++i)
            mesh->vertices.push_back({std::cos(float(i) * std::numbers::pi_v<float> / 3),
                                      std::sin(float(i) * std::numbers::pi_v<float> / 3), z});
    mesh->vertices.emplace_back(); // Embree reads 16 bytes at the last
    for (uint32_t i = 0; i < 6; ++i) {
        const uint32_t next = (i + 1) % 6;
        mesh->triangles.push_back({i, next, i + 6});
        mesh->triangles.push_back({next, next + 6, i + 6});
    }
    for (uint32_t i = 1; i < 5; ++i) {
        mesh->triangles.push_back({0, i + 1, i});
        mesh->triangles.push_back({6, i + 6, i + 7});
    }
    mesh->radius = 1;
    return mesh;
}

/// side x side tilted plates, next to each other at different heights, from the middle of an edge at the origin to +y.
inline SceneDescription plates(int side) {
    SceneDescription scene = empty_scene();
    MaterialDescription material;
    material.albedo = Rgb(0.5f);
    scene.materials.push_back(material);
    ObjectDescription object;
    object.mesh = plate();
    object.materials = {0};
    object.object_indices = {0};
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const auto i = uint64_t(y * side + x);
            const double tilt = 0.2 * double(uniform(1, i)) - 0.1;
            const double rows[12] = {std::cos(tilt),  0, std::sin(tilt), 1.8 * (x - side / 2), 0, 1, 0, 1.8 * y,
                                     -std::sin(tilt), 0, std::cos(tilt), double(uniform(2, i))};
            object.instances.push_back(affine_from_rows(rows));
        }
    scene.objects.push_back(object);
    return scene;
}

} // namespace glimmer
