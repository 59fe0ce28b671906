// SPDX-License-Identifier: GPL-3.0-or-later
// What the scenes of the benchmarks begin with.
#pragma once

#include "scene/description.h"

#include <cmath>

namespace glimmer {

/// A camera and a film as a caller of the C API gets them, and nothing else.
inline SceneDescription empty_scene() {
    SceneDescription scene;
    glimmer_camera_init(&scene.camera.emplace());
    glimmer_film_init(&scene.film.emplace());
    return scene;
}

/// Adds an emissive sphere of a colour of its own. hue: an angle, radians.
inline void add_moon(SceneDescription &scene, float hue, const Vec3d &center, double radius) {
    MaterialDescription light;
    light.type = MaterialType::light;
    light.radiance = {20 + 10 * std::cos(hue), 20 + 10 * std::cos(hue + 2), 20 + 10 * std::cos(hue + 4)};
    SpheresDescription sphere;
    sphere.centers = {center};
    sphere.radii = {radius};
    sphere.material = uint32_t(scene.materials.size());
    scene.materials.push_back(light);
    scene.spheres.push_back(sphere);
}

} // namespace glimmer
