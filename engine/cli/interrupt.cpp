// SPDX-License-Identifier: GPL-3.0-or-later
#include "interrupt.h"

#include <atomic>
#include <csignal>
#include <ctime>

namespace glimmer {
namespace {

// Several senders say the same thing twice: coreutils' timeout signals the process and then its group, a terminal's
// Ctrl-C goes to a wrapper that passes it on. A person who means "at once" is slower than that.
constexpr int64_t kOneRequest = 1'000'000'000;

// When the first signal came, in nanoseconds; 0: none has. A handler may use lock-free atomics alone.
std::atomic<int64_t> first_signal = 0;
static_assert(std::atomic<int64_t>::is_always_lock_free);

extern "C" void note_signal(int number) {
    timespec time = {};
    clock_gettime(CLOCK_MONOTONIC, &time);
    const int64_t now = int64_t(time.tv_sec) * 1'000'000'000 + time.tv_nsec;
    int64_t first = 0;
    if (first_signal.compare_exchange_strong(first, now) || now - first < kOneRequest)
        return;
    std::signal(number, SIG_DFL);
    std::raise(number); // ends the process when this handler returns
}

} // namespace

void catch_interrupts() {
    struct sigaction action = {};
    action.sa_handler = note_signal;
    sigemptyset(&action.sa_mask);
    action.sa_flags = SA_RESTART;
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    // A file that grows past the limit is an error of the write, not the end of the process.
    std::signal(SIGXFSZ, SIG_IGN);
}

bool interrupted() {
    return first_signal != 0;
}

} // namespace glimmer
