// SPDX-License-Identifier: GPL-3.0-or-later
// Images to files that are whole or not there.
#pragma once

#include "image_io.h"

#include <filesystem>

namespace glimmer {

/// Encodes in memory and writes in one piece: OpenImageIO's own .png writer does not notice a full disk. header and
/// pixels as ImageIo::encode takes them. Throws ResultError "FILE: why".
void write_image(const ImageHeader &header, const std::vector<float> &pixels, PixelType type,
                 const std::filesystem::path &path);

} // namespace glimmer
