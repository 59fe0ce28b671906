// SPDX-License-Identifier: GPL-3.0-or-later
// Integer hashes: the source of every random number, and the keys of the scrambles.
#pragma once

#include <cstdint>

namespace glimmer {

inline constexpr uint64_t kGoldenRatio64 = 0x9e3779b97f4a7c15ull;

/// A bijection of 64 bits in which every input bit flips every output bit with probability near 1/2 (Stafford's mix 13,
/// as in SplitMix64, Steele et al. 2014).
constexpr uint64_t mix64(uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
    return x ^ (x >> 31);
}

/// A hash of any number of integers; their order matters.
template <class... T>
constexpr uint64_t hash64(T... values) {
    uint64_t h = 0;
    ((h = mix64((h + kGoldenRatio64) ^ static_cast<uint64_t>(values))), ...);
    return h;
}

/// The upper 24 bits as a number in [0, 1): every value is a multiple of 2^-24, so 1 - u is exact and 1 never comes.
constexpr float unit_float(uint32_t bits) {
    return static_cast<float>(bits >> 8) * 0x1p-24f;
}

constexpr uint32_t reverse_bits(uint32_t x) {
    x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
    x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
    x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
    return __builtin_bswap32(x);
}

} // namespace glimmer
