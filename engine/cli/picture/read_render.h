// SPDX-License-Identifier: GPL-3.0-or-later
// From the engine's passes to a picture.
#pragma once

#include "glimmer.h"
#include "picture.h"
#include "scene_file/scene_file.h"

namespace glimmer {

/// Channel names of a pass: "R" of the combined one, "A" of alpha, "stderr.R", "normal.X", "depth.Z", ...
std::vector<std::string> channel_names(glimmer_pass pass);

/// The combined pass, alpha where the film is transparent, the standard error where it is known, and the passes of a
/// bit set. Leaves the info empty.
Picture read_render(glimmer_render *render, const Film &film, uint64_t passes, bool has_standard_error);

} // namespace glimmer
