// SPDX-License-Identifier: GPL-3.0-or-later
// The error of a render as far as it is known: its curve, how fast it falls, and when it will be where. Not locked.
#pragma once

#include "render/rate.h"

#include <algorithm>

namespace glimmer {

class ErrorCurve {
  public:
    explicit ErrorCurve(double target) : target_(target) {}

    const std::vector<CurvePoint> &points() const { return points_; }
    /// The last point's; unknown while there is none.
    ErrorEstimate error() const { return points_.empty() ? ErrorEstimate{} : points_.back().error; }
    const FallRate &rate() const { return rate_; }
    const Forecast &forecast() const { return forecast_; }
    bool meets_target() const { return !points_.empty() && points_.back().meets(target_); }

    bool has_point_at(uint64_t samples) const { return !points_.empty() && points_.back().samples == samples; }
    /// How many looks at the error had an interval: the next estimate's level depends on it (film/error.h).
    uint32_t looks() const {
        return uint32_t(
            std::count_if(points_.begin(), points_.end(), [](const auto &p) { return p.error.has_interval(); }));
    }
    void add(const CurvePoint &point) {
        points_.push_back(point);
        judge();
    }
    void restore(std::vector<CurvePoint> points) {
        points_ = std::move(points);
        judge();
    }

  private:
    void judge() {
        rate_ = fit_rate(points_);
        forecast_ = glimmer::forecast(points_, rate_, target_);
    }

    double target_;
    std::vector<CurvePoint> points_;
    FallRate rate_;
    Forecast forecast_;
};

} // namespace glimmer
