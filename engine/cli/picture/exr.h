// SPDX-License-Identifier: GPL-3.0-or-later
// Our OpenEXR files: channels, windows and attributes.
#pragma once

#include "picture.h"

#include <filesystem>

namespace glimmer {

/// Throws ResultError that names `target`, whose temporary name `path` is.
void write_exr(const Picture &picture, const std::filesystem::path &path, const std::filesystem::path &target);

} // namespace glimmer
