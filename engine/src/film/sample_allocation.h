// SPDX-License-Identifier: GPL-3.0-or-later
// Adaptive sampling: how many samples each replicate of each pixel takes of the passes that are still to come.
//
// Samples are spent where they lower relMSE most, in proportion to the standard error of a sample over sqrt(mu^2 + eps)
// (Neyman 1934). To judge a pixel by the very samples that its mean is made of is a bias (Kirk and Arvo 1991, "Unbiased
// sampling techniques for image synthesis"): one that happens to be bright too soon gets more samples, which wash its
// luck out; one that happens to be dark gets none, and stays dark. The rule that avoids it, "plan one half of the
// samples by the other", holds for one plan alone: planned once more, the other half's counts, and so what it tells,
// depend on the first half. And its halves are correlated, each through the other's count (where a plate is seen by
// one sample in twelve, a variance taken from replicates that plan each other is 18 % too low). Hence:
//
// - Replicate r is planned by the replicates r + 1, r + 2 and r + 3 (mod 8) alone, by what they gathered in the first
//   kPlanPasses passes, where every pixel takes one sample of each pass. There is one plan, made then. So the count of
//   r is a function of random numbers that are independent of all of r's own (its samples and the passes that it
//   shares with other pixels), for any scrambled sequence within r, and its mean m_r over that count is unbiased.
// - The picture is the mean of the m_r with the weights they have without a plan (equal but for the passes of an
//   unfinished round): weights that know nothing of the values. Weights by the counts would bring the bias back, since
//   the counts of the others depend on r.
// - No two replicates plan each other (r + d = q and q + d' = r would need d + d' = 8 with both at most 3): where r
//   does not plan q, E[m_r - mu | all but r] = 0 while m_q is fixed, so that all m_r are pairwise uncorrelated. The
//   variance of their mean from their spread, and all that film/error.h makes of it, stays unbiased, equal numbers of
//   samples or not. They are not independent, though: counts know of other replicates' luck.
// - No pixel takes less than kLowestRate samples a pass: a pixel that seemed quiet costs at most that factor. Rates are
//   1 in the mean over the picture; less where hardly a pixel has any noise, since none goes above kHighestRate.
#pragma once

#include "sampling/hash.h"

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

namespace glimmer {

class Film;

inline constexpr uint32_t kReplicates = 8;
inline constexpr uint64_t kPlanPasses = 2 * kReplicates;
inline constexpr uint32_t kPlanners = 3; ///< replicates that plan one: the most of which no two plan each other
inline constexpr double kLowestRate = 0.25, kHighestRate = 4; ///< samples a pass

/// Samples of one pixel in one pass: their numbers within the replicate.
struct SampleRange {
    uint64_t first = 0, count = 0;
};

/// Rates of one pixel's replicates, in samples a pass, as multiples of 1/kUnit.
struct PixelPlan {
    static constexpr uint32_t kUnit = 4096;
    std::array<uint16_t, kReplicates> rates;

    PixelPlan() { rates.fill(kUnit); }
    /// Samples that replicate r takes of its first `passes` passes; rounded at random (by `key`), right in the mean.
    uint64_t taken(uint32_t r, uint64_t passes, uint64_t key) const {
        constexpr uint64_t uniform = kPlanPasses / kReplicates;
        if (passes <= uniform || rates[r] == kUnit)
            return passes;
        return uniform + ((passes - uniform) * rates[r] + hash64(key, r) % kUnit) / kUnit;
    }
    /// Passes that one of the samples stands for which are taken by the plan.
    float cover(uint32_t r) const { return float(kUnit) / float(rates[r]); }
};

/// The plan of a film whose every pixel has kPlanPasses samples, row by row; nothing once `stop` is set. Between
/// batches only.
std::vector<PixelPlan> plan_samples(const Film &film, const std::atomic<bool> &stop);

} // namespace glimmer
