// SPDX-License-Identifier: GPL-3.0-or-later
#include "film/error.h"

#include "base/student_t.h"

#include <algorithm>
#include <cmath>

namespace glimmer {

namespace {

constexpr uint32_t kFewestReplicates = 4; // a pair, and two more that tell mu and how well it is known

/// A number for the whole picture, and without each of the replicates.
struct Jackknife {
    double whole = 0;
    std::array<double, kReplicates> without{};

    void add(const Jackknife &other) {
        whole += other.whole;
        for (uint32_t r = 0; r < kReplicates; ++r)
            without[r] += other.without[r];
    }
    /// Standard error of log(whole); infinite where one replicate carries everything.
    double log_error(uint32_t used) const {
        double mean = 0, spread = 0;
        for (uint32_t r = 0; r < used; ++r) {
            if (!(without[r] > 0))
                return std::numeric_limits<double>::infinity();
            mean += std::log(without[r]) / used;
        }
        for (uint32_t r = 0; r < used; ++r) {
            const double d = std::log(without[r]) - mean;
            spread += d * d;
        }
        return std::sqrt(spread * (used - 1) / used);
    }
};

/// What is the same for all pixels of a tile.
struct Counts {
    uint32_t used = 0;
    double total = 0, epsilon = 0;
    std::array<double, kReplicates> of{}; ///< samples of each replicate
};

struct PixelError {
    Jackknife same, crossed;
    double largest = 0; ///< what one replicate adds to crossed.whole
};

/// Adds one channel: `same` has variance and mean from the same samples, `crossed` from different ones.
void add_channel(const Replicates &sums, int c, const Counts &n, PixelError &result,
                 std::array<double, kReplicates> &deviations) {
    // Relative to the first replicate: sums of squares lose nothing, and equal replicates spread by exactly 0.
    std::array<double, kReplicates> x{}, weighted{}, squares{};
    const double origin = double(sums[0][c]) / n.of[0];
    double sum = 0, square_sum = 0;
    for (uint32_t r = 0; r < n.used; ++r) {
        x[r] = double(sums[r][c]) / n.of[r] - origin;
        weighted[r] = n.of[r] * x[r];
        squares[r] = weighted[r] * x[r];
        sum += weighted[r];
        square_sum += squares[r];
    }
    const auto same = [&](double count, double s, double q, uint32_t groups) {
        const double mean = origin + s / count, spread = std::max(q - s * s / count, 0.0);
        return groups < 2 ? 0 : spread / ((groups - 1) * n.total) / (mean * mean + n.epsilon);
    };
    result.same.whole += same(n.total, sum, square_sum, n.used);
    for (uint32_t r = 0; r < n.used; ++r)
        result.same.without[r] += same(n.total - n.of[r], sum - weighted[r], square_sum - squares[r], n.used - 1);
    if (n.used < kFewestReplicates)
        return;

    double pairs = 0;
    std::array<double, kReplicates> pairs_of{}; // that a replicate is in
    for (uint32_t r = 0; r < n.used; ++r)
        for (uint32_t q = r + 1; q < n.used; ++q) {
            const double both = n.of[r] + n.of[q], count = n.total - both;
            const double s = (sum - weighted[r] - weighted[q]) / count, mean = origin + s;
            const double spread = std::max(square_sum - squares[r] - squares[q] - s * s * count, 0.0);
            const double d = x[r] - x[q], unsure = 3 * spread / ((n.used - 3) * count);
            const double value = d * d * n.of[r] * n.of[q] / (both * n.total * (mean * mean + unsure + n.epsilon));
            pairs += value;
            pairs_of[r] += value;
            pairs_of[q] += value;
        }
    const double k = n.used;
    result.crossed.whole += pairs / (k * (k - 1) / 2);
    for (uint32_t r = 0; r < n.used; ++r)
        result.crossed.without[r] += (pairs - pairs_of[r]) / ((k - 1) * (k - 2) / 2);
    const double mean = sum / n.total, scale = 1 / ((origin + mean) * (origin + mean) + n.epsilon);
    for (uint32_t r = 0; r < n.used; ++r)
        deviations[r] += n.of[r] * (x[r] - mean) * (x[r] - mean) * scale;
}

PixelError pixel_error(const Replicates &sums, const Counts &n) {
    PixelError result;
    std::array<double, kReplicates> deviations{};
    for (int c = 0; c < 3; ++c)
        add_channel(sums, c, n, result, deviations);
    double all = 0, most = 0;
    for (const double d : deviations) {
        all += d;
        most = std::max(most, d);
    }
    result.largest = all > 0 ? result.crossed.whole * most / all : 0;
    return result;
}

double image_mean(const Film &film) {
    double sum = 0;
    for (const Rectangle &tile : film.tiles())
        for (uint32_t y = tile.y; y < tile.y + tile.height; ++y)
            for (uint32_t x = tile.x; x < tile.x + tile.width; ++x) {
                const Rgb mean = estimate_pixel(film.replicates(x, y), film.pixel_samples(x, y)).mean;
                sum += (double(mean.r) + double(mean.g) + double(mean.b)) / 3;
            }
    return sum / (double(film.width()) * double(film.height()));
}

} // namespace

std::optional<ErrorEstimate> estimate_error(const Film &film, uint32_t look, const std::atomic<bool> &stop) {
    ErrorEstimate result;
    const auto used = uint32_t(std::min<uint64_t>(film.min_samples(), kReplicates));
    const double mean = image_mean(film);
    if (used < 2 || mean == 0)
        return result;

    Jackknife same, crossed;
    double largest = 0;
    for (size_t t = 0; t < film.tiles().size(); ++t) {
        if (stop.load(std::memory_order_relaxed))
            return std::nullopt;
        const Rectangle &tile = film.tiles()[t];
        const uint64_t n = film.tile_samples(t);
        Counts counts;
        counts.used = uint32_t(std::min<uint64_t>(n, kReplicates));
        counts.total = double(n);
        counts.epsilon = relmse_epsilon(mean);
        for (uint32_t r = 0; r < counts.used; ++r)
            counts.of[r] = double(replicate_samples(n, r));
        for (uint32_t y = tile.y; y < tile.y + tile.height; ++y)
            for (uint32_t x = tile.x; x < tile.x + tile.width; ++x) {
                const PixelError pixel = pixel_error(film.replicates(x, y), counts);
                same.add(pixel.same);
                crossed.add(pixel.crossed);
                if (pixel.largest > largest) {
                    largest = pixel.largest;
                    result.x = x;
                    result.y = y;
                }
            }
    }

    const double values = 3 * double(film.width()) * double(film.height());
    if (used < kFewestReplicates) {
        result.relmse = same.whole / values;
        return result;
    }
    result.relmse = crossed.whole / values;
    result.largest_share = crossed.whole > 0 ? largest / crossed.whole : 0;
    for (uint32_t r = 0; r < used; ++r)
        result.without[r] = crossed.without[r] / values;
    if (crossed.whole == 0) {
        result.low = result.high = result.log_error = 0;
        return result;
    }
    result.log_error = crossed.log_error(used);
    const double tail = (1 - kErrorConfidence) / (2.0 * look * (look + 1.0));
    const double t = student_quantile(tail, used - 1);
    result.high = result.relmse * std::exp(t * result.log_error);
    result.low = std::min(same.whole / values * std::exp(-t * same.log_error(used)),
                          result.relmse * std::exp(-t * result.log_error));
    return result;
}

} // namespace glimmer
