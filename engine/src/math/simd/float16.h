// SPDX-License-Identifier: GPL-3.0-or-later
// Sixteen floats at a time: one register where this file is compiled for AVX-512, else two of AVX2, with the same
// operations in the same order, so that both give the same bits. Everything here has internal linkage, so that each
// instruction set has its own (instruction_set.h).
#pragma once

#include "math/simd/float8.h"
#include "math/simd/instruction_set.h"

#include <cstddef>

namespace glimmer {
namespace {

#ifdef __AVX512F__

struct Float16 {
    __m512 v;

    Float16() : v(_mm512_setzero_ps()) {}
    Float16(__m512 v_) : v(v_) {}
    explicit Float16(float x) : v(_mm512_set1_ps(x)) {}
    static Float16 load(const float *p) { return _mm512_loadu_ps(p); }
    void store(float *p) const { _mm512_storeu_ps(p, v); }
    friend Float16 operator+(Float16 a, Float16 b) { return _mm512_add_ps(a.v, b.v); }
    friend Float16 operator-(Float16 a, Float16 b) { return _mm512_sub_ps(a.v, b.v); }
    friend Float16 operator*(Float16 a, Float16 b) { return _mm512_mul_ps(a.v, b.v); }
    friend Float16 operator/(Float16 a, Float16 b) { return _mm512_div_ps(a.v, b.v); }
    friend Float16 sqrt(Float16 a) { return _mm512_sqrt_ps(a.v); }
    friend Float16 max(Float16 a, Float16 b) { return _mm512_max_ps(a.v, b.v); }
    friend Float16 min(Float16 a, Float16 b) { return _mm512_min_ps(a.v, b.v); }
    friend Float16 round(Float16 a) { return _mm512_roundscale_ps(a.v, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC); }
    friend Float16 power_of_two(Float16 n) {
        return _mm512_castsi512_ps(
            _mm512_slli_epi32(_mm512_add_epi32(_mm512_cvtps_epi32(n.v), _mm512_set1_epi32(127)), 23));
    }
    friend Float16 zero_where_below(Float16 x, Float16 limit, Float16 value) {
        return _mm512_maskz_mov_ps(_mm512_cmp_ps_mask(x.v, limit.v, _CMP_NLT_UQ), value.v);
    }
};

#else

struct Float16 {
    Float8 low, high;

    Float16() = default;
    Float16(Float8 low_, Float8 high_) : low(low_), high(high_) {}
    explicit Float16(float x) : low(x), high(x) {}
    static Float16 load(const float *p) { return {Float8::load(p), Float8::load(p + 8)}; }
    void store(float *p) const {
        low.store(p);
        high.store(p + 8);
    }
    friend Float16 operator+(Float16 a, Float16 b) { return {a.low + b.low, a.high + b.high}; }
    friend Float16 operator-(Float16 a, Float16 b) { return {a.low - b.low, a.high - b.high}; }
    friend Float16 operator*(Float16 a, Float16 b) { return {a.low * b.low, a.high * b.high}; }
    friend Float16 operator/(Float16 a, Float16 b) { return {a.low / b.low, a.high / b.high}; }
    friend Float16 sqrt(Float16 a) { return {sqrt(a.low), sqrt(a.high)}; }
    friend Float16 max(Float16 a, Float16 b) { return {max(a.low, b.low), max(a.high, b.high)}; }
    friend Float16 min(Float16 a, Float16 b) { return {min(a.low, b.low), min(a.high, b.high)}; }
    friend Float16 round(Float16 a) { return {round(a.low), round(a.high)}; }
    friend Float16 power_of_two(Float16 n) { return {power_of_two(n.low), power_of_two(n.high)}; }
    friend Float16 zero_where_below(Float16 x, Float16 limit, Float16 value) {
        return {zero_where_below(x.low, limit.low, value.low), zero_where_below(x.high, limit.high, value.high)};
    }
};

#endif

/// Sum of the lanes, in one fixed order.
inline float sum(Float16 a) {
    float x[kSimdLanes];
    a.store(x);
    for (size_t half = kSimdLanes / 2; half > 0; half /= 2)
        for (size_t i = 0; i < half; ++i)
            x[i] = x[i] + x[i + half];
    return x[0];
}

} // namespace
} // namespace glimmer
