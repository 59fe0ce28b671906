// SPDX-License-Identifier: GPL-3.0-or-later
// Error against run time: the points of the curve, how fast it falls, and when it will be where.
#pragma once

#include "film/error.h"

#include <cstdint>
#include <vector>

namespace glimmer {

/// Below, a target of the error ends no render: with one sample in each replicate, whole kinds of path may not have
/// been met yet.
inline constexpr uint64_t kFewestSamplesToStop = 2 * kReplicates;

struct CurvePoint {
    double seconds = 0, cpu_seconds = 0; ///< of the render so far
    uint64_t samples = 0;
    ErrorEstimate error;

    bool meets(double target) const {
        return target > 0 && samples >= kFewestSamplesToStop && error.certifiable() && error.high <= target;
    }
};

/// relMSE falls as seconds^-power; NaN where fewer than three points tell.
struct FallRate {
    double power = ErrorEstimate::kUnknown, low = ErrorEstimate::kUnknown, high = ErrorEstimate::kUnknown;

    /// The fitted power where its interval is narrower than 1, else 1: what independent samples do.
    double expected() const { return high - low < 1 && power > 0 ? power : 1; }
};

/// Least squares on the logarithms of the points from kFewestSamplesToStop on, weighed by 1/log_error^2. The points are
/// not independent, each holds the samples of those before: the interval (0.95) comes from a jackknife that leaves the
/// same replicate out of all of them. It knows nothing of what a line gets wrong. The rate is the estimate's: as long
/// as that errs upwards (relMSE above 0.1 or so), it falls faster than the error.
FallRate fit_rate(const std::vector<CurvePoint> &curve);

/// Of the curve from its last point on, in render seconds since the start; NaN where nothing tells.
struct Forecast {
    double half = ErrorEstimate::kUnknown;   ///< until relmse is half as large
    double target = ErrorEstimate::kUnknown; ///< until `high` is at most the target at a look, which are at doublings
};
Forecast forecast(const std::vector<CurvePoint> &curve, const FallRate &rate, double target);

} // namespace glimmer
