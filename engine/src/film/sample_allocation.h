// SPDX-License-Identifier: GPL-3.0-or-later
// Adaptive sampling: how many samples each replicate of each pixel takes in the waves that are still to come.
//
// Samples go where they lower relMSE most, in proportion to the standard error of a sample over sqrt(mu^2 + eps)
// (Neyman 1934). Judging a pixel by the very samples that its mean is made of is a bias (Kirk and Arvo 1991, "Unbiased
// sampling techniques for image synthesis"): a pixel that happens to be bright too soon gets more samples, which wash
// its luck out, and one that happens to be dark gets none and stays dark. The common remedy, to allocate one half of
// the samples by the other, holds for one allocation alone: made once more, the other half's counts depend on the first
// half. And its halves are correlated, each through the other's count: where a plate is seen by one sample in twelve, a
// variance taken from replicates that allocate each other is 18 % too low. Hence:
//
// - Replicate r is allocated by the replicates r + 1, r + 2 and r + 3 (mod 8) alone, by what they gathered in the first
//   kUniformWaves waves, where every pixel takes one sample a wave. There is one allocation, made then. So the count of
//   r is a function of random numbers that are independent of all of r's own (its samples, and the waves that it shares
//   with other pixels), for any scrambled sequence within r, and its mean m_r over that count is unbiased.
// - The picture is the mean of the m_r with the weights that they have without an allocation (equal but for the waves
// of
//   an unfinished round): weights that do not depend on the values. Weights by the counts would bring the bias back,
//   since the counts of the others depend on r.
// - No two replicates allocate each other (r + d = q and q + d' = r would need d + d' = 8 with both at most 3). Where r
//   does not allocate q, E[m_r - mu | all but r] = 0 while m_q is fixed, so all m_r are pairwise uncorrelated. The
//   variance of their mean from their spread, and all that film/error.h makes of it, stays unbiased, whether or not
//   they have equal numbers of samples. They are not independent, though: the counts depend on other replicates' luck.
// - No pixel takes less than kLowestRate samples a wave, so a pixel that seemed quiet costs at most that factor. Rates
//   are 1 in the mean over the picture; less where hardly a pixel has any noise, since none goes above kHighestRate.
#pragma once

#include "film/replicates.h"
#include "sampling/hash.h"

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

namespace glimmer {

class Film;

/// Waves in which every pixel takes one sample, before the allocation. Chosen: two samples for each replicate.
inline constexpr uint64_t kUniformWaves = 2 * kReplicates;
/// Replicates that allocate one: the most of which no two allocate each other.
inline constexpr uint32_t kAllocators = 3;
static_assert(2 * kAllocators < kReplicates, "two replicates would allocate each other");
/// Bounds of the rate, in samples a wave. Chosen.
inline constexpr double kLowestRate = 0.25, kHighestRate = 4;

/// Samples of one pixel in one wave: their numbers within the replicate.
struct SampleRange {
    uint64_t first = 0, count = 0;
};

/// Rates of one pixel's replicates, in samples a wave, as multiples of 1/kUnit.
struct PixelAllocation {
    static constexpr uint32_t kUnit = 4096;
    std::array<uint16_t, kReplicates> rates;

    PixelAllocation() { rates.fill(kUnit); }
    /// Samples that replicate r takes of its first `waves` waves. Rounded at random by `key`, so that the mean is
    /// right.
    uint64_t taken(uint32_t r, uint64_t waves, uint64_t key) const {
        constexpr uint64_t uniform = kUniformWaves / kReplicates;
        if (waves <= uniform || rates[r] == kUnit)
            return waves;
        return uniform + ((waves - uniform) * rates[r] + hash64(key, r) % kUnit) / kUnit;
    }
    /// The waves that one sample of replicate r stands for, after the uniform ones.
    float waves_a_sample(uint32_t r) const { return float(kUnit) / float(rates[r]); }
};

/// The allocation of a film whose every pixel has kUniformWaves samples, row by row; empty once `stop` is set. Between
/// batches only.
std::vector<PixelAllocation> allocate_samples(const Film &film, const std::atomic<bool> &stop);

} // namespace glimmer
