// SPDX-License-Identifier: GPL-3.0-or-later
// The two ways in which the command fails, and its exit statuses.
#pragma once

#include <stdexcept>
#include <string>

namespace glimmer {

enum ExitStatus : int {
    kDone = 0,
    kBadInput = 1,     ///< a bad scene or bad arguments
    kNoResult = 2,     ///< the render or the writing of its result failed
    kInterrupted = 130 ///< SIGINT or SIGTERM; what was rendered so far is written
};

/// A bad scene or bad arguments: one line that says what is wrong, where, and what is allowed. Exit status 1.
struct InputError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// No result could be made of a good scene: one line. Exit status 2.
struct ResultError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

} // namespace glimmer
