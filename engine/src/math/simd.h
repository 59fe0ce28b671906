// SPDX-License-Identifier: GPL-3.0-or-later
// Eight floats at a time (AVX2, which x86-64-v3 promises), for the inner loops over light vertices and nodes of tables.
#pragma once

#include "math/vec.h"

#include <cmath>
#include <immintrin.h>

namespace glimmer {

struct Float8 {
    __m256 v;

    Float8() : v(_mm256_setzero_ps()) {}
    Float8(__m256 v_) : v(v_) {}
    explicit Float8(float x) : v(_mm256_set1_ps(x)) {}
    static Float8 load(const float *p) { return _mm256_loadu_ps(p); }
    void store(float *p) const { _mm256_storeu_ps(p, v); }
    friend Float8 operator+(Float8 a, Float8 b) { return _mm256_add_ps(a.v, b.v); }
    friend Float8 operator-(Float8 a, Float8 b) { return _mm256_sub_ps(a.v, b.v); }
    friend Float8 operator*(Float8 a, Float8 b) { return _mm256_mul_ps(a.v, b.v); }
    friend Float8 operator/(Float8 a, Float8 b) { return _mm256_div_ps(a.v, b.v); }
};

inline Float8 sqrt(Float8 a) {
    return _mm256_sqrt_ps(a.v);
}
inline Float8 max(Float8 a, Float8 b) {
    return _mm256_max_ps(a.v, b.v);
}
inline Float8 min(Float8 a, Float8 b) {
    return _mm256_min_ps(a.v, b.v);
}

/// Sum of the lanes, in one fixed order.
inline float sum(Float8 a) {
    alignas(32) float x[8];
    _mm256_store_ps(x, a.v);
    return ((x[0] + x[4]) + (x[1] + x[5])) + ((x[2] + x[6]) + (x[3] + x[7]));
}

/// e^x to 3e-7 relative, 0 below -87: 2^n times a polynomial on [-ln 2 / 2, ln 2 / 2] (Cephes expf).
inline Float8 exp(Float8 x) {
    const __m256 clamped = _mm256_max_ps(_mm256_min_ps(x.v, _mm256_set1_ps(88.0f)), _mm256_set1_ps(-87.3f));
    const __m256 n = _mm256_round_ps(_mm256_mul_ps(clamped, _mm256_set1_ps(1.44269504088896341f)),
                                     _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
    // ln 2 in two parts, so that the subtraction is exact.
    const Float8 r = Float8(clamped) - Float8(n) * Float8(0.693359375f) - Float8(n) * Float8(-2.12194440e-4f);
    Float8 p(1.9875691500e-4f);
    p = p * r + Float8(1.3981999507e-3f);
    p = p * r + Float8(8.3334519073e-3f);
    p = p * r + Float8(4.1665795894e-2f);
    p = p * r + Float8(1.6666665459e-1f);
    p = p * r + Float8(5.0000001201e-1f);
    p = p * r * r + r + Float8(1.0f);
    const __m256i bits = _mm256_slli_epi32(_mm256_add_epi32(_mm256_cvtps_epi32(n), _mm256_set1_epi32(127)), 23);
    const __m256 value = _mm256_mul_ps(p.v, _mm256_castsi256_ps(bits));
    return _mm256_andnot_ps(_mm256_cmp_ps(x.v, _mm256_set1_ps(-87.3f), _CMP_LT_OQ), value);
}

/// e^(-depth) of three channels at once. Depths may be infinite, of either sign.
inline Rgb exp_minus(const Rgb &depth) {
    // Where the vector form would end early or overflow: the subnormal tail is kept.
    constexpr float kMost = 87;
    if (!(max_component(depth) < kMost && std::min(depth.r, std::min(depth.g, depth.b)) > -kMost))
        return {std::exp(-depth.r), std::exp(-depth.g), std::exp(-depth.b)};
    alignas(32) float x[8];
    exp(Float8(_mm256_setr_ps(-depth.r, -depth.g, -depth.b, 0, 0, 0, 0, 0))).store(x);
    return {x[0], x[1], x[2]};
}

} // namespace glimmer
