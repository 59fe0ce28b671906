// SPDX-License-Identifier: GPL-3.0-or-later
// What a worker takes along wherever it traces rays.
#pragma once

#include "film/sample.h"

#include <atomic>
#include <cstdint>

namespace glimmer {

/// Counts the worker's rays and tells it when nobody waits for the result any more.
struct TraceContext {
    uint64_t rays = 0;
    const std::atomic<bool> *stop = nullptr; ///< set from outside to cancel; null: never cancelled
    PassSample *passes = nullptr;            ///< where a camera sample puts what passes show; null: nowhere
    bool stopped() const { return stop && stop->load(std::memory_order_relaxed); }
};

/// Ends a walk from vertex to vertex that would not end by itself: where light is shut in for good, Russian roulette
/// never comes to an end. One guard serves one camera sample, or one light subpath, with all of its branches.
class WalkGuard {
  public:
    explicit WalkGuard(const TraceContext &trace) : trace_(trace) {}
    /// To be asked before each vertex. False once the walk has kMaxVertices of them or was cancelled.
    bool goes_on() {
        return ++vertices_ < kMaxVertices && (vertices_ % kCancelCheckInterval != 0 || !trace_.stopped());
    }

  private:
    /// So many vertices take hours. No walk that still brings anything reaches this number.
    static constexpr uint64_t kMaxVertices = 1ull << 32;
    /// So many vertices pass between two looks at the flag: less than a millisecond of work, and yet the look is too
    /// rare to cost anything.
    static constexpr uint64_t kCancelCheckInterval = 4096;

    const TraceContext &trace_;
    uint64_t vertices_ = 0;
};

} // namespace glimmer
