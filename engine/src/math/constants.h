// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace glimmer {

inline constexpr float kPi = 3.14159265358979323846f;
inline constexpr double kPiDouble = 3.14159265358979323846;
inline constexpr float kInfinity = __builtin_inff();

} // namespace glimmer
