// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/student_t.h"
#include "film/error.h"
#include "film_probe.h"
#include "render/rate.h"

using namespace glimmer;

/// sums [height, width, 8, 3] of the replicates after `samples` samples. result: relmse, low, high, largest_share, x,
/// y, log_error, relmse without each of the replicates [8].
PROBE void probe_error(const float *sums, uint32_t width, uint32_t height, uint64_t samples, uint32_t look,
                       double *result) {
    Film film(width, height, 32, 0);
    probe::load_replicates(film, sums, samples);
    const std::optional<ErrorEstimate> e = estimate_error(film, look, std::atomic<bool>(false));
    const double values[] = {e->relmse, e->low, e->high, e->largest_share, double(e->x), double(e->y), e->log_error};
    result = std::copy(std::begin(values), std::end(values), result);
    std::copy(e->without.begin(), e->without.end(), result);
}

PROBE double probe_student_quantile(double tail, uint32_t degrees) {
    return student_quantile(tail, degrees);
}

/// seconds, relmse, log_error [n], without [n, 8]. result: rate, low, high.
PROBE void probe_rate(const double *seconds, const double *relmse, const double *log_error, const double *without,
                      uint64_t n, double *result) {
    std::vector<CurvePoint> curve(n, CurvePoint{});
    for (uint64_t i = 0; i < n; ++i) {
        curve[i].seconds = seconds[i];
        curve[i].samples = uint64_t(1) << i;
        curve[i].error.relmse = relmse[i];
        curve[i].error.low = 0;
        curve[i].error.log_error = log_error[i];
        std::copy_n(without + kReplicates * i, kReplicates, curve[i].error.without.begin());
    }
    const FallRate rate = fit_rate(curve);
    result[0] = rate.power;
    result[1] = rate.low;
    result[2] = rate.high;
}
