// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/student_t.h"

#include <cmath>
#include <numbers>

namespace glimmer {

namespace {

/// P(T > t) for t >= 0.
double student_tail(double t, uint32_t degrees) {
    const double theta = std::atan2(t, std::sqrt(double(degrees))), c = std::cos(theta), s = std::sin(theta);
    // 1 - A(t), with A the probability of -t to t.
    double sum = 0, term = degrees % 2 ? c : 1;
    for (uint32_t k = degrees % 2 ? 3 : 2; k <= degrees; k += 2) {
        sum += term;
        term *= c * c * double(k - 1) / double(k);
    }
    const double within = degrees % 2 ? (theta + s * sum) * 2 / std::numbers::pi : s * sum;
    return (1 - within) / 2;
}

} // namespace

double student_quantile(double tail, uint32_t degrees) {
    double low = 0, high = 1;
    while (student_tail(high, degrees) > tail)
        high *= 2;
    for (int i = 0; i < 80; ++i) {
        const double middle = 0.5 * (low + high);
        (student_tail(middle, degrees) > tail ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

} // namespace glimmer
