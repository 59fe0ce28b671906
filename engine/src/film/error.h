// SPDX-License-Identifier: GPL-3.0-or-later
// How wrong the picture is, from the spread of its independent replicates alone.
#pragma once

#include "film/film.h"

#include <limits>
#include <optional>

namespace glimmer {

/// Probability that the intervals of all looks at a render hold the expected relMSE at once.
inline constexpr double kErrorConfidence = 0.95;
/// Above this share of the estimate in one pixel of one replicate, the error is not certifiable. The sizes of rare
/// bright samples fall off like a power law: the brighter ones that this render has not met carry, at a tail index of
/// 1.5, three times what the brightest met carries. 0.1 leaves them within the factor that the interval has anyway.
inline constexpr double kLargestShareAllowed = 0.1;

/// The eps of relMSE: what keeps dark pixels from deciding it. The stopping rule and the sample allocation share it.
constexpr double relmse_epsilon(double image_mean) {
    return 1e-4 * image_mean * image_mean; // (0.01 image_mean)^2
}

/// relMSE = mean over pixels and channels of Var(mean) / (mu^2 + eps), eps = (0.01 * image mean)^2.
///
/// Var(mean) is estimated from pairs of replicates, (m_r - m_q)^2 n_r n_q / ((n_r + n_q) n), and divided by mu^2 from
/// all the *other* replicates, so that a bright sample never stands above and below the line (with both from the same
/// samples a pixel cannot exceed 1, whatever it has met: the estimate was 3 to 10 times too low where rare bright
/// samples make the error). The noise of that mu, variance V, would raise the mean of 1/mu^2 by 3 V/mu^4: 1/(mu^2 + 3V
/// + eps) takes the first order of it out. What is left errs upwards, and is gone when all pixels are well known.
///
/// The interval: from the estimate with both from the same samples, which errs downwards, to this one; each widened by
/// a jackknife over the replicates on its logarithm (Efron and Tibshirani 1993, ch. 11; Student's t at replicates - 1
/// degrees of freedom). At the k-th look the level is 0.05/(k (k + 1)): over all looks they sum to 0.05, so that a
/// render may stop at whichever look it likes. Approximate: tails that no sample has met are in no interval, and
/// `largest_share` is the only word about them.
struct ErrorEstimate {
    static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

    /// NaN where not known: below 2 samples, or a black picture. With 2 or 3 replicates it is the one that errs
    /// downwards.
    double relmse = kUnknown;
    double low = kUnknown, high = kUnknown; ///< known from 4 replicates on; high may be infinite
    double largest_share = kUnknown;        ///< of the estimate, in one pixel of one replicate
    uint32_t x = 0, y = 0;                  ///< that pixel, of the crop
    /// Standard error of log(relmse), and relmse by all replicates but one; from 4 replicates on.
    double log_error = kUnknown;
    std::array<double, kReplicates> without{};

    bool has_interval() const { return low == low; }
    bool certifiable() const { return largest_share <= kLargestShareAllowed || relmse == 0; }
};

/// look: 1 at the first estimate that has an interval. Not locked: for use between batches. Nothing once `stop` is set.
std::optional<ErrorEstimate> estimate_error(const Film &film, uint32_t look, const std::atomic<bool> &stop);

} // namespace glimmer
