// SPDX-License-Identifier: GPL-3.0-or-later
#include "film/sample_allocation.h"

#include "film/error.h"

#include <algorithm>
#include <cmath>

namespace glimmer {

namespace {

/// Scores are averaged over neighbours up to so many pixels away, since the variance of a single pixel from three
/// replicates is too uncertain. Chosen.
constexpr uint32_t kBlurRadius = 2;

/// The variance of a replicate over mu^2 + eps, summed over channels, as those that allocate `allocated` estimate it.
double score(const Replicates &sums, uint32_t allocated, double epsilon) {
    constexpr double waves = double(kUniformWaves) / kReplicates;
    double result = 0;
    for (int c = 0; c < 3; ++c) {
        std::array<double, kAllocators> means{};
        double mean = 0, spread = 0;
        for (uint32_t d = 0; d < kAllocators; ++d) {
            means[d] = double(sums[(allocated + 1 + d) % kReplicates][c]) / waves;
            mean += means[d] / kAllocators;
        }
        for (const double m : means)
            spread += (m - mean) * (m - mean);
        // As in film/error.h, the noise of mu is taken out of 1/mu^2: 3 times its variance, spread/2 over kAllocators.
        const double variance = spread / (kAllocators - 1);
        const double scale = mean * mean + 3 * variance / kAllocators + epsilon;
        result += scale > 0 ? variance / scale : 0;
    }
    return std::isfinite(result) ? result : 0; // sums that left the range of float
}

double mean_of_allocators(const Film &film, uint32_t allocated) {
    double sum = 0;
    for (uint32_t y = 0; y < film.height(); ++y)
        for (uint32_t x = 0; x < film.width(); ++x) {
            const Replicates sums = film.replicates(x, y);
            for (uint32_t d = 0; d < kAllocators; ++d) {
                const Rgb &s = sums[(allocated + 1 + d) % kReplicates];
                sum += double(s.r) + double(s.g) + double(s.b);
            }
        }
    const double waves = double(kUniformWaves) / kReplicates;
    return sum / (3 * kAllocators * waves * double(film.width()) * double(film.height()));
}

/// Means over the neighbours within kBlurRadius, of those that there are, along one axis: `count` lines of `length`.
void blur(std::vector<float> &values, size_t count, size_t length, size_t line_step, size_t step) {
    std::vector<float> line(length);
    for (size_t i = 0; i < count; ++i) {
        float *at = values.data() + i * line_step;
        for (size_t j = 0; j < length; ++j)
            line[j] = at[j * step];
        for (size_t j = 0; j < length; ++j) {
            const size_t first = j > kBlurRadius ? j - kBlurRadius : 0, end = std::min(j + kBlurRadius + 1, length);
            float sum = 0;
            for (size_t k = first; k < end; ++k)
                sum += line[k];
            at[j * step] = sum / float(end - first);
        }
    }
}

double rate_of(float wanted, double scale) {
    return std::clamp(scale * double(wanted), kLowestRate, kHighestRate);
}

/// What to multiply the wanted rates by so that they are 1 in the mean, once they are held between the bounds.
double scale_to_mean_one(const std::vector<float> &wanted) {
    const float most = *std::max_element(wanted.begin(), wanted.end());
    if (!(most > 0))
        return 0;
    double low = kLowestRate / double(most), high = low;
    const auto mean = [&](double scale) {
        double sum = 0;
        for (const float w : wanted)
            sum += rate_of(w, scale);
        return sum / double(wanted.size());
    };
    while (mean(high) < 1 && high < 1e30)
        high *= 2;
    for (int i = 0; i < 24; ++i) {
        const double middle = 0.5 * (low + high);
        (mean(middle) < 1 ? low : high) = middle;
    }
    return high;
}

} // namespace

std::vector<PixelAllocation> allocate_samples(const Film &film, const std::atomic<bool> &stop) {
    const size_t width = film.width(), height = film.height();
    std::vector<PixelAllocation> allocation(width * height);
    std::vector<float> wanted(width * height);
    for (uint32_t r = 0; r < kReplicates; ++r) {
        if (stop.load(std::memory_order_relaxed))
            return {};
        const double mean = mean_of_allocators(film, r), epsilon = relmse_epsilon(mean);
        for (uint32_t y = 0; y < film.height(); ++y)
            for (uint32_t x = 0; x < film.width(); ++x)
                wanted[size_t(y) * width + x] = float(score(film.replicates(x, y), r, epsilon));
        blur(wanted, height, width, width, 1);
        blur(wanted, width, height, 1, width);
        for (float &w : wanted)
            w = std::sqrt(w);
        const double scale = scale_to_mean_one(wanted);
        for (size_t i = 0; i < wanted.size(); ++i)
            if (scale > 0)
                allocation[i].rates[r] = uint16_t(std::lround(rate_of(wanted[i], scale) * PixelAllocation::kUnit));
    }
    return allocation;
}

} // namespace glimmer
