// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers out of the bytes of a file.
#pragma once

#include <algorithm>
#include <bit>
#include <cstring>

namespace glimmer {

static_assert(std::endian::native == std::endian::little, "the readers take the machine to be little-endian");

/// The number at a place of any alignment; swap: the file is big-endian.
template <class T>
T load(const char *bytes, bool swap) {
    char copy[sizeof(T)];
    std::memcpy(copy, bytes, sizeof(T));
    if (swap)
        std::reverse(copy, copy + sizeof(T));
    return std::bit_cast<T>(copy);
}

} // namespace glimmer
