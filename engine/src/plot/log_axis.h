// SPDX-License-Identifier: GPL-3.0-or-later
// A logarithmic axis of a plot.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace glimmer {

/// Values from `low` to `high` (0 < low < high) onto pixels from `begin` to `end`.
struct LogAxis {
    double low, high, begin, end;

    /// Room around the values, and at least a decade, so that there are ticks.
    static LogAxis around(double low, double high, double begin, double end) {
        low /= 1.3;
        high *= 1.3;
        if (const double widen = std::sqrt(10 * low / high); widen > 1) {
            low /= widen;
            high *= widen;
        }
        return {low, high, begin, end};
    }

    double operator()(double value) const { return begin + (end - begin) * std::log10(value / low) / decades(); }
    /// For values of any size: a little beyond the axis instead of far beyond it.
    double clamped(double value) const { return (*this)(std::clamp(value, low / 2, high * 2)); }
    double decades() const { return std::log10(high / low); }
    double value_at(double pixel) const { return low * std::pow(high / low, (pixel - begin) / (end - begin)); }

    /// 1, 2 and 5 times the powers of ten; these powers alone, or each second, third and so on, where more would stand
    /// closer than `spacing` pixels.
    std::vector<double> ticks(double spacing) const {
        const double decade = std::abs(end - begin) / decades();
        const int first = int(std::floor(std::log10(low))), last = int(std::ceil(std::log10(high)));
        const bool fine = decade * std::log10(2.0) >= spacing;
        const int step = std::max(1, int(std::ceil(spacing / decade)));
        std::vector<double> result;
        for (int exponent = first; exponent <= last; ++exponent)
            for (const double digit : {1.0, 2.0, 5.0}) {
                const double value = digit * std::pow(10, exponent);
                const bool wanted = digit == 1 ? (exponent - first) % step == 0 : fine;
                if (wanted && value >= low * (1 - 1e-9) && value <= high * (1 + 1e-9))
                    result.push_back(value);
            }
        return result;
    }
};

} // namespace glimmer
