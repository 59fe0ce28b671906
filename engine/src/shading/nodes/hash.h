// SPDX-License-Identifier: GPL-3.0-or-later
// Hashes of lattice points and of floats, bit for bit those of Blender's textures: Bob Jenkins' lookup3 (public domain)
// and, for Voronoi from Blender 4.2, PCG in two to four dimensions (Jarzynski and Olano, Hash Functions for GPU
// Rendering, JCGT 9(3), 2020) on signed numbers.
#pragma once

#include "math/vec.h"

#include <array>
#include <bit>
#include <cstdint>
#include <span>

namespace glimmer::nodes {

/// lookup3 of one to four words: the last word of the final state.
template <size_t N>
constexpr uint32_t hash_words(const std::array<uint32_t, N> &k) {
    static_assert(N >= 1 && N <= 4);
    const auto rot = [](uint32_t x, int n) { return std::rotl(x, n); };
    uint32_t a = 0xdeadbeefu + (uint32_t(N) << 2) + 13u, b = a, c = a;
    a += k[0];
    if constexpr (N > 1)
        b += k[1];
    if constexpr (N > 2)
        c += k[2];
    if constexpr (N > 3) {
        a = (a - c) ^ rot(c, 4), c += b;
        b = (b - a) ^ rot(a, 6), a += c;
        c = (c - b) ^ rot(b, 8), b += a;
        a = (a - c) ^ rot(c, 16), c += b;
        b = (b - a) ^ rot(a, 19), a += c;
        c = (c - b) ^ rot(b, 4), b += a;
        a += k[3];
    }
    c = (c ^ b) - rot(b, 14);
    a = (a ^ c) - rot(c, 11);
    b = (b ^ a) - rot(a, 25);
    c = (c ^ b) - rot(b, 16);
    a = (a ^ c) - rot(c, 4);
    b = (b ^ a) - rot(a, 14);
    c = (c ^ b) - rot(b, 24);
    return c;
}

/// Of floats by their bits, to [0, 1].
template <class... Float>
float hash_floats(Float... k) {
    const std::array<uint32_t, sizeof...(k)> words{std::bit_cast<uint32_t>(float(k))...};
    return float(hash_words(words)) * (1.0f / 4294967295.0f);
}

/// A point of one to four dimensions.
template <size_t N>
using Point = std::array<float, N>;

template <size_t N>
float hash_point(const Point<N> &p) {
    std::array<uint32_t, N> words{};
    for (size_t i = 0; i < N; ++i)
        words[i] = std::bit_cast<uint32_t>(p[i]);
    return float(hash_words(words)) * (1.0f / 4294967295.0f);
}

/// Three numbers in [0, 1] of a point.
inline Vec3f hash_color(const Point<1> &p) {
    return {hash_floats(p[0]), hash_floats(p[0], 1.0f), hash_floats(p[0], 2.0f)};
}
inline Vec3f hash_color(const Point<2> &p) {
    return {hash_floats(p[0], p[1]), hash_floats(p[0], p[1], 1.0f), hash_floats(p[0], p[1], 2.0f)};
}
inline Vec3f hash_color(const Point<3> &p) {
    return {hash_floats(p[0], p[1], p[2]), hash_floats(p[0], p[1], p[2], 1.0f), hash_floats(p[0], p[1], p[2], 2.0f)};
}
inline Vec3f hash_color(const Point<4> &p) {
    return {hash_floats(p[0], p[1], p[2], p[3]), hash_floats(p[2], p[0], p[3], p[1]),
            hash_floats(p[3], p[2], p[1], p[0])};
}

/// A point of as many dimensions in [0, 1]^N.
inline Point<1> hash_jitter(const Point<1> &p) {
    return {hash_floats(p[0])};
}
inline Point<2> hash_jitter(const Point<2> &p) {
    return {hash_floats(p[0], p[1]), hash_floats(p[0], p[1], 1.0f)};
}
inline Point<3> hash_jitter(const Point<3> &p) {
    const Vec3f c = hash_color(p);
    return {c.x, c.y, c.z};
}
inline Point<4> hash_jitter(const Point<4> &p) {
    return {hash_floats(p[0], p[1], p[2], p[3]), hash_floats(p[3], p[0], p[1], p[2]),
            hash_floats(p[2], p[3], p[0], p[1]), hash_floats(p[1], p[2], p[3], p[0])};
}

/// PCG on signed words: the shift keeps the sign. Unsigned arithmetic, which may wrap.
template <size_t N>
std::array<uint32_t, N> pcg_words(std::array<uint32_t, N> v) {
    static_assert(N >= 2 && N <= 4);
    for (uint32_t &x : v)
        x = x * 1664525u + 1013904223u;
    const auto stir = [&v] {
        if constexpr (N == 2) {
            v[0] += v[1] * 1664525u;
            v[1] += v[0] * 1664525u;
        } else if constexpr (N == 3) {
            v[0] += v[1] * v[2];
            v[1] += v[2] * v[0];
            v[2] += v[0] * v[1];
        } else {
            v[0] += v[1] * v[3];
            v[1] += v[2] * v[0];
            v[2] += v[0] * v[1];
            v[3] += v[1] * v[2];
        }
    };
    stir();
    for (uint32_t &x : v)
        x ^= uint32_t(int32_t(x) >> 16);
    stir();
    return v;
}

template <size_t N>
Point<N> pcg_point(const std::array<int32_t, N> &cell) {
    std::array<uint32_t, N> words{};
    for (size_t i = 0; i < N; ++i)
        words[i] = uint32_t(cell[i]);
    words = pcg_words(words);
    Point<N> out{};
    for (size_t i = 0; i < N; ++i)
        out[i] = float(words[i] & 0x7fffffffu) * (1.0f / 2147483647.0f);
    return out;
}

} // namespace glimmer::nodes
