// SPDX-License-Identifier: GPL-3.0-or-later
// A rendered picture with its layers and where it came from.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace glimmer {

/// Facts that travel with the picture, as attributes "glimmer:NAME" of an .exr.
struct PictureInfo {
    uint64_t samples = 0;           ///< per pixel
    std::vector<std::string> seeds; ///< one, or one for each merged picture
    double seconds = 0;             ///< of rendering, all merged pictures together
    std::string version, scene_hash, integrator;
    std::vector<std::string> biased_by;
};

struct Picture {
    uint32_t width = 0, height = 0;    ///< of the whole picture
    float pixel_aspect = 1;            ///< width / height of a pixel
    std::array<uint32_t, 4> window{};  ///< x0, y0, x1, y1: the part that is there
    std::vector<std::string> channels; ///< "R", "G", "B", "stderr.R", ..., "depth.Z"
    std::vector<float> pixels;         ///< (window height, window width, channels), top row first
    PictureInfo info;

    uint32_t window_width() const { return window[2] - window[0]; }
    uint32_t window_height() const { return window[3] - window[1]; }
    size_t pixel_count() const { return size_t(window_width()) * window_height(); }
};

} // namespace glimmer
