// SPDX-License-Identifier: GPL-3.0-or-later
// Our OpenEXR files: channels, windows and attributes.
#pragma once

#include "picture.h"

#include <filesystem>

namespace glimmer {

/// Throws ResultError.
void write_exr(const Picture &picture, const std::filesystem::path &path);

} // namespace glimmer
