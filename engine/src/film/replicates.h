// SPDX-License-Identifier: GPL-3.0-or-later
// Replicates: the radiance of a pixel is kept in several independent sums, from whose spread every statement about the
// error comes. Sample s belongs to replicate s mod kReplicates.
#pragma once

#include "math/vec.h"

#include <array>
#include <cstdint>

namespace glimmer {

inline constexpr uint32_t kReplicates = 8;

/// The sum of the samples of each replicate.
using Replicates = std::array<Rgb, kReplicates>;

/// Samples of replicate r among the first n.
constexpr uint64_t replicate_samples(uint64_t n, uint32_t r) {
    return (n + kReplicates - 1 - r) / kReplicates;
}

/// The mean of one pixel and its standard error, which is NaN below 2 samples. (A variance would leave the range of
/// float long before the radiance does.)
struct PixelEstimate {
    Rgb mean;
    Rgb standard_error;
};

/// Mean and standard error of replicate sums after n samples. Var(mean) = sum_r n_r (m_r - m)^2 / ((R - 1) n), which is
/// unbiased when the samples of one pixel are independent and its replicates hold n_r of them.
PixelEstimate estimate_pixel(const Replicates &sums, uint64_t n);

} // namespace glimmer
