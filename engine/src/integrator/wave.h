// SPDX-License-Identifier: GPL-3.0-or-later
// What an integrator prepares once for many camera samples: for a wave, which is one sample of every pixel, and for a
// block of pixels within it.
#pragma once

#include <cstddef>
#include <cstdint>

namespace glimmer {

/// What all pixels of a wave share.
struct WaveData {
    virtual ~WaveData() = default;
    /// Memory taken by its arrays.
    virtual size_t bytes() const = 0;
};

/// What the pixels of one block share within a wave.
struct BlockData {
    virtual ~BlockData() = default;
};

/// The side of a block, in pixels of the whole picture. Blocks do not depend on tiles, so that no picture does; tiles
/// are made of whole blocks.
inline constexpr uint32_t kBlockSize = 32;

} // namespace glimmer
