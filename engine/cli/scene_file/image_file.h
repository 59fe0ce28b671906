// SPDX-License-Identifier: GPL-3.0-or-later
// Images of the environment.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace glimmer {

struct ImageData {
    uint32_t width = 0, height = 0;
    std::vector<float> rgb; ///< (height, width, 3), linear, top row first, finite, >= 0
};

/// Any format that OpenImageIO reads. The colour space that it names (sRGB for 8-bit files that say nothing, linear for
/// float) is undone; grey becomes RGB, alpha is ignored. Throws InputError "NAME: what".
ImageData read_image(const std::filesystem::path &path, const std::string &name);

} // namespace glimmer
