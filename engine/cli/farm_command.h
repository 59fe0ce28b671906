// SPDX-License-Identifier: GPL-3.0-or-later
// glimmer farm SCENE.json -o OUT.exr ...: one frame over many machines, by the Python package engine/farm.
#pragma once

#include "options.h"

namespace glimmer {

/// Turns this process into that program, which renders with this very command. Returns only by an exception.
int run_farm(const FarmOptions &options);

} // namespace glimmer
