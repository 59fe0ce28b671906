// SPDX-License-Identifier: GPL-3.0-or-later
// Plain values into a stream of bytes and back, for saved states.
#pragma once

#include "base/error.h"

#include <cstdint>
#include <cstring>
#include <vector>

namespace glimmer {

template <class T>
void append(std::vector<uint8_t> &out, const T *data, size_t count) {
    if (count == 0)
        return;
    const size_t old = out.size();
    out.resize(old + count * sizeof(T));
    std::memcpy(out.data() + old, data, count * sizeof(T));
}

/// Throws Error when fewer bytes are left.
template <class T>
void take(const uint8_t *&data, const uint8_t *end, T *out, size_t count) {
    if (size_t(end - data) / sizeof(T) < count)
        fail_argument("the saved state ends too early");
    if (count == 0)
        return;
    std::memcpy(static_cast<void *>(out), data, count * sizeof(T));
    data += count * sizeof(T);
}

} // namespace glimmer
