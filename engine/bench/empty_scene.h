// SPDX-License-Identifier: GPL-3.0-or-later
// What the scenes of the benchmarks begin with.
#pragma once

#include "scene/description.h"

namespace glimmer {

/// A camera and a film as a caller of the C API gets them, and nothing else.
inline SceneDescription empty_scene() {
    SceneDescription scene;
    glimmer_camera_init(&scene.camera.emplace());
    glimmer_film_init(&scene.film.emplace());
    return scene;
}

} // namespace glimmer
