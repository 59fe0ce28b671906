// SPDX-License-Identifier: GPL-3.0-or-later
// Images through OpenImageIO to files that are whole or not there.
#pragma once

#include <OpenImageIO/imageio.h>
#include <filesystem>

namespace glimmer {

/// Encodes in memory and writes in one piece: OpenImageIO's own .png writer does not notice a full disk.
/// Throws ResultError "FILE: why".
void write_image(const OIIO::ImageSpec &spec, OIIO::TypeDesc type, const void *pixels, const char *format,
                 const std::filesystem::path &path);

} // namespace glimmer
