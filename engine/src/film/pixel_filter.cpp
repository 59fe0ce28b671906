// SPDX-License-Identifier: GPL-3.0-or-later
#include "film/pixel_filter.h"

#include "math/constants.h"

#include <algorithm>
#include <cmath>

namespace glimmer {

namespace {

/// Inverse CDF of the Blackman-Harris window over [-0.5, 0.5] at equal steps of the CDF. The first and the last step
/// spread evenly over a long tail that is all but empty: with 256 steps it got ten times its light.
std::vector<float> invert_blackman_harris() {
    constexpr int kFine = 65536, kSteps = 4096;
    const auto window = [](double x) { // x in [0, 1]
        const double a = 2 * kPiDouble * x;
        return 0.35875 - 0.48829 * std::cos(a) + 0.14128 * std::cos(2 * a) - 0.01168 * std::cos(3 * a);
    };
    std::vector<double> cdf(kFine + 1, 0.0);
    for (size_t i = 0; i < kFine; ++i)
        cdf[i + 1] = cdf[i] + window((double(i) + 0.5) / kFine);
    std::vector<float> inverse;
    size_t i = 0;
    for (int s = 0; s <= kSteps; ++s) {
        const double target = cdf[kFine] * s / kSteps;
        while (i + 1 < kFine && cdf[i + 1] < target)
            ++i;
        const double f = (target - cdf[i]) / (cdf[i + 1] - cdf[i]);
        inverse.push_back(float((double(i) + std::min(std::max(f, 0.0), 1.0)) / kFine - 0.5));
    }
    return inverse;
}

/// In one dimension.
void set_weights(const PixelFilter &filter, float folded, uint32_t reach, float *weights) {
    float sum = 0;
    for (uint32_t i = 0; i <= 2 * reach; ++i) {
        weights[i] = filter.density(folded + float(reach) - float(i));
        sum += weights[i];
    }
    for (uint32_t i = 0; i <= 2 * reach; ++i) // rounding may move a sample off the edge of the only filter there
        weights[i] = sum > 0 ? weights[i] / sum : float(i == reach);
}

} // namespace

FilterWeights PixelFilter::weights(Vec2f folded) const {
    FilterWeights result;
    result.reach = reach();
    set_weights(*this, folded.x, result.reach, result.x.data());
    set_weights(*this, folded.y, result.reach, result.y.data());
    return result;
}

PixelFilter PixelFilter::blackman_harris(float width) {
    return PixelFilter(width, invert_blackman_harris());
}

PixelFilter::PixelFilter(float width, std::vector<float> inverse) : width_(width), inverse_(std::move(inverse)) {
    const size_t steps = inverse_.size() - 1;
    density_.assign(inverse_.size(), 0.0f);
    for (size_t i = 1; i <= steps; ++i)
        density_[i] = 1 / ((inverse_[i] - inverse_[i - 1]) * width_ * float(steps));
    first_above_.resize(steps + 1);
    for (size_t k = 0; k <= steps; ++k) {
        // One part earlier than where it begins: rounding may take an offset for one of the next part.
        const float begin = inverse_.front() + (inverse_.back() - inverse_.front()) * (float(k) - 1) / float(steps);
        first_above_[k] =
            uint16_t(std::upper_bound(inverse_.begin() + 1, inverse_.end() - 1, begin) - inverse_.begin());
    }
}

} // namespace glimmer
