// SPDX-License-Identifier: GPL-3.0-or-later
#include "film/error.h"

#include <cmath>
#include <limits>

namespace glimmer {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
// Student's t, 0.975, for 2 to 7 degrees of freedom (index: degrees).
constexpr std::array<double, kReplicates> kStudent{0, 0, 4.3027, 3.1824, 2.7764, 2.5706, 2.4469, 2.3646};

/// What one pixel adds to the relMSE of the picture made of all replicates but `left_out` (kReplicates: none), at the
/// error that all samples would have.
double pixel_error(const Replicates &sums, uint64_t n, uint32_t used, uint32_t left_out, double epsilon) {
    double result = 0;
    for (int c = 0; c < 3; ++c) {
        double total = 0, count = 0;
        for (uint32_t r = 0; r < used; ++r)
            if (r != left_out) {
                total += double(sums[r][c]);
                count += double(replicate_samples(n, r));
            }
        const double mean = total / count;
        double spread = 0;
        for (uint32_t r = 0; r < used; ++r)
            if (r != left_out) {
                const double k = double(replicate_samples(n, r)), d = double(sums[r][c]) / k - mean;
                spread += k * d * d;
            }
        const double groups = double(used - (left_out < used ? 1 : 0));
        result += spread / ((groups - 1) * double(n)) / (mean * mean + epsilon);
    }
    return result / 3;
}

} // namespace

std::optional<ErrorEstimate> estimate_error(const Film &film, const std::atomic<bool> &stop) {
    const double pixels = double(film.width()) * double(film.height());
    const uint64_t least = film.min_samples();
    const auto used = uint32_t(std::min<uint64_t>(least, kReplicates));
    if (used < 2)
        return ErrorEstimate{kNaN, kNaN, kNaN};

    double image_mean = 0;
    for (const Rectangle &tile : film.tiles())
        for (uint32_t y = tile.y; y < tile.y + tile.height; ++y)
            for (uint32_t x = tile.x; x < tile.x + tile.width; ++x) {
                const Rgb mean = estimate_pixel(film.replicates(x, y), film.pixel_samples(x, y)).mean;
                image_mean += (double(mean.r) + double(mean.g) + double(mean.b)) / 3;
            }
    image_mean /= pixels;
    if (image_mean == 0)
        return ErrorEstimate{kNaN, kNaN, kNaN};
    const double epsilon = 1e-4 * image_mean * image_mean;

    double whole = 0;
    std::array<double, kReplicates> without{};
    for (size_t t = 0; t < film.tiles().size(); ++t) {
        if (stop.load(std::memory_order_relaxed))
            return std::nullopt;
        const Rectangle &tile = film.tiles()[t];
        const uint64_t n = film.tile_samples(t);
        const auto here = uint32_t(std::min<uint64_t>(n, kReplicates));
        for (uint32_t y = tile.y; y < tile.y + tile.height; ++y)
            for (uint32_t x = tile.x; x < tile.x + tile.width; ++x) {
                const Replicates &sums = film.replicates(x, y);
                whole += pixel_error(sums, n, here, kReplicates, epsilon);
                if (used >= 3)
                    for (uint32_t r = 0; r < used; ++r)
                        without[r] += pixel_error(sums, n, here, r, epsilon);
            }
    }
    whole /= pixels;
    if (used < 3 || whole == 0)
        return ErrorEstimate{whole, whole == 0 ? 0 : kNaN, whole == 0 ? 0 : kNaN};

    double mean_log = 0;
    for (uint32_t r = 0; r < used; ++r)
        mean_log += std::log(without[r] / pixels) / used;
    double spread = 0;
    for (uint32_t r = 0; r < used; ++r) {
        const double d = std::log(without[r] / pixels) - mean_log;
        spread += d * d;
    }
    const double error = std::sqrt(spread * (used - 1) / used);
    const double factor = std::exp(kStudent[used - 1] * error);
    return ErrorEstimate{whole, whole / factor, whole * factor};
}

} // namespace glimmer
