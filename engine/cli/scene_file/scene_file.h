// SPDX-License-Identifier: GPL-3.0-or-later
// The scene file (SCENE_FORMAT.md) to a scene of the engine.
#pragma once

#include "handles.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace glimmer {

struct Film {
    uint32_t width = 0, height = 0;
    float pixel_aspect = 1;         ///< width / height of a pixel
    std::array<uint32_t, 4> crop{}; ///< x0, y0, x1, y1 of what is rendered; the whole picture without a crop
    bool transparent = false;       ///< the environment is not seen, and pictures have alpha

    uint32_t crop_width() const { return crop[2] - crop[0]; }
    uint32_t crop_height() const { return crop[3] - crop[1]; }
};

/// Scattering vertices of a path; -1 is no limit.
struct DepthLimits {
    int64_t max_depth = -1, max_scatter = -1;
};

struct LoadedScene {
    SceneHandle scene; ///< not yet committed
    Film film;
    DepthLimits limits;
    std::string hash;                  ///< of the scene's whole content, see SceneFolder::content_hash
    std::vector<std::string> left_out; ///< what the file holds and nothing uses
};

/// Throws InputError (the file is at fault) or ResultError (we are), each with one line.
LoadedScene load_scene(const std::filesystem::path &file);

} // namespace glimmer
