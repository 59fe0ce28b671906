// SPDX-License-Identifier: GPL-3.0-or-later
// How wrong the picture is, from the spread of its independent replicates alone.
#pragma once

#include "film/film.h"

#include <optional>

namespace glimmer {

/// relMSE = mean over pixels and channels of Var(mean) / (mean^2 + eps), eps = (0.01 * image mean)^2. NaN where not
/// known: below 2 samples, or a black picture; the interval below 3. The interval is two-sided, of confidence 0.95: a
/// jackknife over the replicates on the logarithm, with Student's t at (replicates - 1) degrees of freedom.
/// Approximate: heavy tails that no sample has met yet are in no interval.
struct ErrorEstimate {
    double relmse, low, high;
};

inline constexpr double kErrorConfidence = 0.95;

/// Not locked: for use between batches. Nothing once `stop` is set.
std::optional<ErrorEstimate> estimate_error(const Film &film, const std::atomic<bool> &stop);

} // namespace glimmer
