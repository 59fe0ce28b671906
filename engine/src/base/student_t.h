// SPDX-License-Identifier: GPL-3.0-or-later
// Student's t distribution, for intervals.
#pragma once

#include <cstdint>

namespace glimmer {

/// t with P(T > t) = tail for T of so many degrees of freedom (1 to 100); 0 < tail < 0.5, good to 1e-9 of t down to a
/// tail of 1e-9. Abramowitz and Stegun (1964), 26.7.3 and 26.7.4, by bisection.
double student_quantile(double tail, uint32_t degrees);

} // namespace glimmer
