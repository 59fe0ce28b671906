// SPDX-License-Identifier: GPL-3.0-or-later
// Progress on the standard error: one line that is updated on a terminal, else a line every few seconds.
#pragma once

#include "glimmer.h"

#include <chrono>
#include <string>

namespace glimmer {

class ProgressLine {
  public:
    explicit ProgressLine(bool quiet);
    ~ProgressLine() { clear(); }

    /// Shows the state when it is time to.
    void update(const glimmer_progress &progress);
    /// A line that stays.
    void say(const std::string &line);
    /// Also when it is quiet.
    void complain(const std::string &line);

  private:
    void clear();

    using Clock = std::chrono::steady_clock;
    bool quiet_, is_terminal_, shown_ = false;
    Clock::time_point next_;
};

/// "relMSE 0.0031 (0.0028 to 0.0035)", or "" while it is not known.
std::string error_text(const glimmer_progress &progress);
/// "not certifiable: heavy tails (34 % of the error in one pixel of one replicate, at (3, 5); at most 10 %)", or "".
std::string tails_text(const glimmer_progress &progress);
/// "falls as time^-0.98 (-1.06 to -0.91)", or "" while it is not known.
std::string rate_text(const glimmer_progress &progress);

} // namespace glimmer
