// SPDX-License-Identifier: GPL-3.0-or-later
// glimmer SCENE.json -o OUT
#pragma once

#include "options.h"

namespace glimmer {

/// Returns kDone or kInterrupted; throws InputError and ResultError.
int run_render(const RenderOptions &options);

} // namespace glimmer
