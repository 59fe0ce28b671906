// SPDX-License-Identifier: GPL-3.0-or-later
// glimmer merge A.exr B.exr ... -o C.exr
#pragma once

#include "options.h"
#include "picture/picture.h"

namespace glimmer {

int run_merge(const MergeOptions &options);

} // namespace glimmer
