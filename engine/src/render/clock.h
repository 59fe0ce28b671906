// SPDX-License-Identifier: GPL-3.0-or-later
// Clocks of a render: wall time without its pauses, and the CPU time of a thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <ctime>

namespace glimmer {

/// Seconds since some moment in the past; never set back.
inline double steady_seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

inline uint64_t thread_cpu_nanoseconds() {
    timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return uint64_t(t.tv_sec) * 1000000000u + uint64_t(t.tv_nsec);
}

/// The seconds that a render has run, over pauses and checkpoints. Not locked.
class RenderClock {
  public:
    void start() {
        running_ = true;
        since_ = steady_seconds();
    }
    void stop() {
        earlier_ = elapsed();
        running_ = false;
    }
    /// Sets the clock, which stands, to what an earlier run took.
    void restore(double seconds) { earlier_ = seconds; }
    double elapsed() const { return earlier_ + (running_ ? steady_seconds() - since_ : 0); }
    /// The moment, in steady_seconds(), at which the render will have run so long if it does not pause.
    double moment_of(double seconds) const { return since_ + seconds - earlier_; }

  private:
    bool running_ = false;
    double since_ = 0, earlier_ = 0;
};

} // namespace glimmer
