// SPDX-License-Identifier: GPL-3.0-or-later
// Exponential variates from 64 random bits.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace glimmer {

/// The unit-mean exponential distribution restricted to [0, tau), tau > 0, possibly infinite, by inversion: increases
/// with bits. -log(1 - u (1 - e^-tau)) in float is 61 % off at tau = 1e-7, and ends at 16.6 when u has 24 bits. Here
/// the lower half of the numbers goes through log1p and expm1, the upper half starts from 1 - u: the tail reaches 45
/// and small values keep all digits.
inline float truncated_exponential(uint64_t bits, float tau) {
    constexpr uint64_t kHalf = 1ull << 63;
    if (bits < kHalf) {
        const float u = (static_cast<float>(static_cast<int64_t>(bits)) + 0.5f) * 0x1p-64f;
        return std::min(-std::log1p(u * std::expm1(-tau)), tau);
    }
    const float v = (static_cast<float>(static_cast<int64_t>(~bits)) + 0.5f) * 0x1p-64f; // 1 - u, at most 1/2
    if (tau < 1) // v + (1 - v) e^-tau is near 1 here: again the difference from 1
        return std::min(-std::log1p((1 - v) * std::expm1(-tau)), tau);
    return std::min(-std::log(v + (1 - v) * std::exp(-tau)), tau);
}

/// The whole unit-mean exponential distribution.
inline float exponential(uint64_t bits) {
    constexpr uint64_t kHalf = 1ull << 63;
    if (bits < kHalf)
        return -std::log1p(-(static_cast<float>(static_cast<int64_t>(bits)) + 0.5f) * 0x1p-64f);
    return -std::log((static_cast<float>(static_cast<int64_t>(~bits)) + 0.5f) * 0x1p-64f);
}

} // namespace glimmer
