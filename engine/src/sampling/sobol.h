// SPDX-License-Identifier: GPL-3.0-or-later
// Owen-scrambled Sobol points in two dimensions: a (0,2)-sequence in base 2.
#pragma once

#include "sampling/hash.h"

#include <cstdint>

namespace glimmer {

/// A hash in which each output bit depends on the same and lower input bits alone: on a bit-reversed number, that is a
/// nested uniform (Owen) scramble. After Laine and Karras 2011, with the constants of Vegdahl ("Building a Better LK
/// Hash", 2021). The key must be well mixed.
constexpr uint32_t laine_karras(uint32_t x, uint32_t key) {
    x ^= x * 0x3d20adeau;
    x += key;
    x *= (key >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

/// Owen scramble of a binary fraction whose most significant bit is the highest.
constexpr uint32_t owen_scramble(uint32_t x, uint32_t key) {
    return reverse_bits(laine_karras(reverse_bits(x), key));
}

/// The second Sobol dimension, bit-reversed: Pascal's triangle modulo 2 times the index, where the entry (row i, column
/// j) is odd exactly when the bits of i are a subset of those of j; hence the five steps of a superset sum.
constexpr uint32_t sobol_second_reversed(uint32_t index) {
    index ^= (index >> 1) & 0x55555555u;
    index ^= (index >> 2) & 0x33333333u;
    index ^= (index >> 4) & 0x0f0f0f0fu;
    index ^= (index >> 8) & 0x00ff00ffu;
    index ^= index >> 16;
    return index;
}

struct SobolPoint {
    uint32_t x, y; ///< binary fractions of 32 bits
};

/// Point `index` of the shuffled and scrambled sequence of a key. The shuffle is itself an Owen scramble of the index
/// (Burley 2020, JCGT 9(4)): every aligned block of 2^k indices stays a block of the sequence and is a (0,k,2)-net.
constexpr SobolPoint owen_sobol(uint32_t index, uint64_t key) {
    const uint64_t keys = mix64(key + kGoldenRatio64), shuffle = mix64(key ^ 0x6a09e667f3bcc909ull);
    const uint32_t i = owen_scramble(index, static_cast<uint32_t>(shuffle >> 32));
    return {reverse_bits(laine_karras(i, static_cast<uint32_t>(keys >> 32))),
            reverse_bits(laine_karras(sobol_second_reversed(i), static_cast<uint32_t>(keys)))};
}

} // namespace glimmer
