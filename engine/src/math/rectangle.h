// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace glimmer {

/// Pixels [x, x + width) by [y, y + height), from the top left.
struct Rectangle {
    uint32_t x = 0, y = 0, width = 0, height = 0;
};

} // namespace glimmer
