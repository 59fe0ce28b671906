// SPDX-License-Identifier: GPL-3.0-or-later
// Room for the closures of points whose materials vary from place to place.
#pragma once

#include "bsdf/bsdf.h"

#include <memory>
#include <span>
#include <vector>

namespace glimmer {

/// Closures stay where they are until clear(), so that a Bsdf may point at them. Not for several threads at once.
class ClosureArena {
  public:
    static constexpr size_t kMaxClosures = 32; ///< of one point

    /// Room for `count` closures, at most kMaxClosures; what stood there before is undefined.
    std::span<WeightedLobe> take(size_t count) {
        if (used_ % kChunk + count > kChunk) // a point's closures stand in one chunk
            used_ += kChunk - used_ % kChunk;
        if (used_ / kChunk >= chunks_.size())
            chunks_.push_back(std::make_unique<WeightedLobe[]>(kChunk));
        const std::span<WeightedLobe> room(chunks_[used_ / kChunk].get() + used_ % kChunk, count);
        used_ += count;
        return room;
    }
    /// Forgets all closures and keeps the room.
    void clear() { used_ = 0; }
    size_t bytes() const { return chunks_.size() * kChunk * sizeof(WeightedLobe); }

  private:
    static constexpr size_t kChunk = 256;
    static_assert(kMaxClosures <= kChunk);
    std::vector<std::unique_ptr<WeightedLobe[]>> chunks_;
    size_t used_ = 0;
};

} // namespace glimmer
