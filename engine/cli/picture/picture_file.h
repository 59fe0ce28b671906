// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures to and from files.
#pragma once

#include "picture.h"

#include <filesystem>

namespace glimmer {

/// ".exr" of "Dir/Moon.EXR".
std::string lower_extension(const std::filesystem::path &path);

/// By its ending: .exr all channels as 32-bit floats, the window as the data window; .pfm and .hdr the window's R G B,
/// linear; .png the window's R G B through display_value. Whole or not at all. Throws ResultError.
void write_picture(const Picture &picture, const std::filesystem::path &path);

/// Opens what write_picture needs, which takes a moment for .png and .hdr: found missing before the render rather than
/// after it. Throws ResultError.
void expect_writable(const std::filesystem::path &path);

/// A picture that write_picture wrote as .exr. Throws InputError "FILE: what".
Picture read_picture(const std::filesystem::path &path);

/// The tone map of .png: no exposure, no curve but sRGB's own (IEC 61966-2-1), clipped to 0..1, rounded to 8 bits: what
/// Blender's "Standard" view transform shows.
uint8_t display_value(float linear);

} // namespace glimmer
