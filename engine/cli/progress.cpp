// SPDX-License-Identifier: GPL-3.0-or-later
#include "progress.h"

#include "text.h"

#include <cmath>
#include <cstdio>
#include <unistd.h>

namespace glimmer {
namespace {

constexpr auto kTerminalInterval = std::chrono::milliseconds(200);
constexpr auto kLineInterval = std::chrono::seconds(5);

} // namespace

std::string error_text(const glimmer_progress &progress) {
    if (std::isnan(progress.relmse))
        return "";
    char text[96];
    if (std::isnan(progress.relmse_low) || std::isnan(progress.relmse_high))
        std::snprintf(text, sizeof text, "relMSE %.3g", progress.relmse);
    else
        std::snprintf(text, sizeof text, "relMSE %.3g (%.3g to %.3g)", progress.relmse, progress.relmse_low,
                      progress.relmse_high);
    return text;
}

std::string tails_text(const glimmer_progress &progress) {
    if (!progress.heavy_tails)
        return "";
    char text[160];
    std::snprintf(
        text, sizeof text,
        "not certifiable: heavy tails (%.0f %% of the error in one pixel of one replicate, at (%u, %u); at most "
        "10 %%)",
        100 * progress.largest_share, progress.largest_x, progress.largest_y);
    return text;
}

std::string rate_text(const glimmer_progress &progress) {
    if (std::isnan(progress.rate))
        return "";
    char text[96];
    std::snprintf(text, sizeof text, "falls as time^%.2f (%.2f to %.2f)", -progress.rate, -progress.rate_high,
                  -progress.rate_low);
    return text;
}

ProgressLine::ProgressLine(bool quiet)
    : quiet_(quiet), is_terminal_(isatty(STDERR_FILENO) == 1),
      next_(Clock::now() + (is_terminal_ ? Clock::duration{} : kLineInterval)) {}

void ProgressLine::update(const glimmer_progress &progress) {
    if (quiet_ || Clock::now() < next_)
        return;
    next_ = Clock::now() + (is_terminal_ ? Clock::duration(kTerminalInterval) : Clock::duration(kLineInterval));
    std::string line;
    if (progress.fraction > 0) {
        char percent[16];
        std::snprintf(percent, sizeof percent, "%3.0f %%  ", 100 * progress.fraction);
        line += percent;
    }
    line += std::to_string(progress.samples) + " spp  " + clock_text(progress.seconds);
    if (progress.seconds_left >= 0)
        line += "  " + clock_text(progress.seconds_left) + " left";
    if (const std::string error = error_text(progress); !error.empty())
        line += "  " + error;
    if (progress.heavy_tails)
        line += ", heavy tails";
    else if (!std::isnan(progress.rate) && progress.seconds_to_half >= 0)
        line += ", half in " + clock_text(progress.seconds_to_half);
    if (progress.seconds_to_target >= 0)
        line += ", at the target in " + clock_text(progress.seconds_to_target);
    std::fprintf(stderr, is_terminal_ ? "\r%s\x1b[K" : "%s\n", line.c_str());
    std::fflush(stderr);
    shown_ = is_terminal_;
}

void ProgressLine::clear() {
    if (shown_)
        std::fputs("\r\x1b[K", stderr);
    shown_ = false;
}

void ProgressLine::say(const std::string &line) {
    if (!quiet_)
        complain(line);
}

void ProgressLine::complain(const std::string &line) {
    clear();
    std::fprintf(stderr, "%s\n", line.c_str());
}

} // namespace glimmer
