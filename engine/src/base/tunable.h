// SPDX-License-Identifier: GPL-3.0-or-later
// Constants that can be measured again. An ordinary build has them as constexpr. A build with GLIMMER_TUNABLE reads
// each one, when the library is loaded, from the environment variable GLIMMER_<name> if that is set, so that `build.py
// bench --tuning NAME` can vary one constant without compiling the engine for every value.
#pragma once

#ifdef GLIMMER_TUNABLE

#include <cstdlib>

namespace glimmer::detail {
template <class T>
T tuned(const char *variable, T value) {
    const char *text = std::getenv(variable);
    return text ? T(std::strtod(text, nullptr)) : value;
}
} // namespace glimmer::detail

#define GLIMMER_TUNABLE_CONSTANT(type, name, value)                                                                    \
    inline const type name = ::glimmer::detail::tuned<type>("GLIMMER_" #name, value)

#else

#define GLIMMER_TUNABLE_CONSTANT(type, name, value) inline constexpr type name = value

#endif
