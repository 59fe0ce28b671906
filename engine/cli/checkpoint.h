// SPDX-License-Identifier: GPL-3.0-or-later
// The state of a render in a file.
#pragma once

#include "handles.h"

#include <filesystem>
#include <string>

namespace glimmer {

/// Hands the state in a file to a render that has not started; false: there is no such file. A file of another scene
/// (by its hash), one that is damaged, or one that the engine does not take is an InputError that names it.
bool load_checkpoint(const std::filesystem::path &path, const std::string &scene_hash, glimmer_render *render);

/// Saves a paused or ended render; the file is replaced in one step. Throws ResultError.
void save_checkpoint(const std::filesystem::path &path, const std::string &scene_hash, glimmer_render *render);

} // namespace glimmer
