// SPDX-License-Identifier: GPL-3.0-or-later
// Eight floats at a time (AVX2, which x86-64-v3 promises), and e^x of as many lanes as there are.
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

/// 2^n of lanes that hold whole numbers from -126 to 127.
inline Float8 power_of_two(Float8 n) {
    return _mm256_castsi256_ps(
        _mm256_slli_epi32(_mm256_add_epi32(_mm256_cvtps_epi32(n.v), _mm256_set1_epi32(127)), 23));
}
inline Float8 round(Float8 a) {
    return _mm256_round_ps(a.v, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
}
/// value, and 0 in the lanes where x < limit.
inline Float8 zero_where_below(Float8 x, Float8 limit, Float8 value) {
    return _mm256_andnot_ps(_mm256_cmp_ps(x.v, limit.v, _CMP_LT_OQ), value.v);
}

/// e^x to 3e-7 relative, 0 below -87: 2^n times a polynomial on [-ln 2 / 2, ln 2 / 2] (Cephes expf).
template <class Float>
inline Float exp(Float x) {
    const Float least(-87.3f), clamped = max(min(x, Float(88.0f)), least);
    const Float n = round(clamped * Float(1.44269504088896341f));
    // ln 2 in two parts, so that the subtraction is exact.
    const Float r = clamped - n * Float(0.693359375f) - n * Float(-2.12194440e-4f);
    Float p(1.9875691500e-4f);
    p = p * r + Float(1.3981999507e-3f);
    p = p * r + Float(8.3334519073e-3f);
    p = p * r + Float(4.1665795894e-2f);
    p = p * r + Float(1.6666665459e-1f);
    p = p * r + Float(5.0000001201e-1f);
    p = p * r * r + r + Float(1.0f);
    return zero_where_below(x, least, p * power_of_two(n));
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
