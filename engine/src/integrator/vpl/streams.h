// SPDX-License-Identifier: GPL-3.0-or-later
// Independent streams of random numbers for what pixels share.
#pragma once

#include "sampling/sampler.h"

#include <cstdint>

namespace glimmer {

/// The values only keep the streams apart.
enum class Stream : uint64_t { wave = 0x9a55, block = 0xb10c, pilot = 0x9107 };

inline Sampler make_stream(Stream stream, uint64_t seed, uint64_t sample, uint32_t x, uint32_t y) {
    return {hash64(seed, uint64_t(stream)), x, y, uint32_t(sample >> 32), uint32_t(sample)};
}

} // namespace glimmer
