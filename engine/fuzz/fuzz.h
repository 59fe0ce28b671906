// SPDX-License-Identifier: GPL-3.0-or-later
// What the fuzzers hold the code to, beyond the sanitizers.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <sanitizer/allocator_interface.h>
#include <string_view>

namespace glimmer {

/// Ends the process, which the fuzzer reports with its input.
inline void require(bool holds, std::string_view what) {
    if (holds)
        return;
    std::fprintf(stderr, "fuzz: %.*s\n", static_cast<int>(what.size()), what.data());
    std::abort();
}

/// Every message is one line of a length that a terminal can show.
inline void expect_one_line(std::string_view message) {
    require(!message.empty(), "an empty message");
    require(message.find_first_of("\n\r") == std::string_view::npos, message);
    require(message.size() < 2000, "a message without end");
}

/// Runs it, and again while it leaves memory behind: what fills a cache does so once. LeakSanitizer cannot do this:
/// it does not live with the threads of Embree's task scheduler.
template <class Run>
void expect_no_leak(const Run &run) {
    constexpr int kRuns = 6;
    for (int i = 0; i < kRuns; ++i) {
        const size_t before = __sanitizer_get_current_allocated_bytes();
        run();
        if (__sanitizer_get_current_allocated_bytes() <= before)
            return;
    }
    require(false, "every run leaves memory behind");
}

} // namespace glimmer
