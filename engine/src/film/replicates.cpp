// SPDX-License-Identifier: GPL-3.0-or-later
#include "film/replicates.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace glimmer {

PixelEstimate estimate_pixel(const Replicates &sums, uint64_t n) {
    PixelEstimate e;
    const auto used = uint32_t(std::min<uint64_t>(n, kReplicates));
    for (int c = 0; c < 3; ++c) {
        double total = 0;
        for (uint32_t r = 0; r < used; ++r)
            total += double(sums[r][c]);
        const double mean = n ? total / double(n) : 0;
        e.mean[c] = float(mean);
        if (used < 2) {
            e.standard_error[c] = std::numeric_limits<float>::quiet_NaN();
            continue;
        }
        double spread = 0;
        for (uint32_t r = 0; r < used; ++r) {
            const double count = double(replicate_samples(n, r)), d = double(sums[r][c]) / count - mean;
            spread += count * d * d;
        }
        e.standard_error[c] = float(std::sqrt(spread / (double(used - 1) * double(n))));
    }
    return e;
}

} // namespace glimmer
