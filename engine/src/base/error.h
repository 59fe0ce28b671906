// SPDX-License-Identifier: GPL-3.0-or-later
// The one exception of the engine: a result code and a line for the user. It never crosses the C API.
#pragma once

#include "glimmer.h"

#include <stdexcept>
#include <string>

namespace glimmer {

class Error : public std::runtime_error {
  public:
    Error(glimmer_result code_, const std::string &message) : std::runtime_error(message), code(code_) {}
    glimmer_result code;
};

[[noreturn]] inline void fail_argument(const std::string &message) {
    throw Error(GLIMMER_INVALID_ARGUMENT, message);
}
[[noreturn]] inline void fail_state(const std::string &message) {
    throw Error(GLIMMER_INVALID_STATE, message);
}

} // namespace glimmer
