// SPDX-License-Identifier: GPL-3.0-or-later
// Files that are either whole or not there.
#pragma once

#include <filesystem>
#include <string_view>

namespace glimmer {

/// Writes bytes under a temporary name beside the file and moves them to their place: a failure leaves nothing new and
/// what was there before. Throws ResultError "FILE: why".
void write_file(const std::filesystem::path &path, std::string_view bytes);

} // namespace glimmer
