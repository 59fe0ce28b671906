// SPDX-License-Identifier: GPL-3.0-or-later
// From the description of a camera to what it sees where, for those besides the camera who ask.
#pragma once

#include "camera/panorama.h"
#include "scene/description.h"
#include "scene/scene.h"

namespace glimmer {

/// Of a camera that is one.
Panorama make_panorama(const glimmer_camera_desc &camera, const FilmSettings &film);

} // namespace glimmer
