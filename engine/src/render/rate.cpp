// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/rate.h"

#include "base/student_t.h"

#include <algorithm>
#include <cmath>

namespace glimmer {

namespace {

constexpr size_t kFewestPoints = 3;

/// Slope of y over x by weights.
double slope(const std::vector<double> &x, const std::vector<double> &y, const std::vector<double> &weights) {
    double w = 0, wx = 0, wy = 0, wxx = 0, wxy = 0;
    for (size_t i = 0; i < x.size(); ++i) {
        w += weights[i];
        wx += weights[i] * x[i];
        wy += weights[i] * y[i];
    }
    for (size_t i = 0; i < x.size(); ++i) {
        const double dx = x[i] - wx / w;
        wxx += weights[i] * dx * dx;
        wxy += weights[i] * dx * (y[i] - wy / w);
    }
    return wxy / wxx;
}

bool usable(const CurvePoint &point) {
    const ErrorEstimate &e = point.error;
    return point.samples >= kFewestSamplesToStop && point.seconds > 0 && e.has_interval() && e.log_error > 0 &&
           std::isfinite(e.log_error);
}

} // namespace

FallRate fit_rate(const std::vector<CurvePoint> &curve) {
    std::vector<double> x, y, weights;
    std::vector<const ErrorEstimate *> estimates;
    for (const CurvePoint &point : curve)
        if (usable(point)) {
            x.push_back(std::log(point.seconds));
            y.push_back(std::log(point.error.relmse));
            weights.push_back(1 / (point.error.log_error * point.error.log_error));
            estimates.push_back(&point.error);
        }
    FallRate rate;
    if (x.size() < kFewestPoints || x.back() <= x.front())
        return rate;
    rate.power = -slope(x, y, weights);
    std::array<double, kReplicates> without{};
    double mean = 0, spread = 0;
    for (uint32_t r = 0; r < kReplicates; ++r) {
        for (size_t i = 0; i < x.size(); ++i)
            y[i] = std::log(estimates[i]->without[r]);
        without[r] = -slope(x, y, weights);
        mean += without[r] / kReplicates;
    }
    for (const double power : without)
        spread += (power - mean) * (power - mean);
    const double half_width = student_quantile((1 - kErrorConfidence) / 2, kReplicates - 1) *
                              std::sqrt(spread * (kReplicates - 1) / kReplicates);
    rate.low = rate.power - half_width;
    rate.high = rate.power + half_width;
    return rate;
}

Forecast forecast(const std::vector<CurvePoint> &curve, const FallRate &rate, double target) {
    Forecast result;
    if (curve.empty() || !(curve.back().error.relmse > 0) || curve.back().seconds <= 0)
        return result;
    const CurvePoint &last = curve.back();
    const double power = rate.expected();
    result.half = last.seconds * std::pow(2.0, 1 / power);
    if (target > 0 && last.error.certifiable() && std::isfinite(last.error.high)) {
        const double growth = std::max(std::pow(std::max(last.error.high / target, 1.0), 1 / power),
                                       double(kFewestSamplesToStop) / double(last.samples));
        const double samples = std::exp2(std::ceil(std::log2(double(last.samples) * growth) - 1e-9));
        result.target = last.seconds * samples / double(last.samples);
    }
    return result;
}

} // namespace glimmer
