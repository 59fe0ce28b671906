// SPDX-License-Identifier: GPL-3.0-or-later
// The random numbers of one sample of one pixel.
#pragma once

#include "math/vec.h"
#include "sampling/exponential.h"
#include "sampling/hash.h"
#include "sampling/sobol.h"

#include <cstdint>

namespace glimmer {

/// Numbers depend on (seed, pixel, replicate, index) and on which call it is, on nothing else: no thread, tile or
/// order. A value type of a few words; copy it to replay.
///
/// next_*: independent numbers from a counter, without end.
///
/// stratified_*(dimension): the point `index` of an Owen-scrambled Sobol sequence of two dimensions. Each `dimension`
/// (dimensions.h) has a scramble and a shuffle of its own (padding), and so have pixels and replicates. Within a pixel
/// and replicate, the indices 0, 1, 2, ... of a dimension are stratified against each other. A dimension is meant for
/// one decision at one vertex of a path: never spread one over different vertices.
///
/// All floats are multiples of 2^-24 in [0, 1), never 1.
class Sampler {
  public:
    Sampler(uint64_t seed, uint32_t pixel_x, uint32_t pixel_y, uint32_t replicate, uint32_t index)
        : scramble_(hash64(seed, pixel_x, pixel_y, replicate)), stream_(hash64(scramble_, index)),
          step_(mix64(stream_ ^ kGoldenRatio64) | 1), index_(index) {}

    /// 64 independent bits.
    uint64_t next_bits() { return mix64(stream_ + step_ * ++counter_); }
    float next_1d() { return unit_float(static_cast<uint32_t>(next_bits() >> 32)); }
    Vec2f next_2d() {
        const uint64_t bits = next_bits();
        return {unit_float(static_cast<uint32_t>(bits >> 32)), unit_float(static_cast<uint32_t>(bits))};
    }
    /// True with the probability p, exact to a part in 2^24 down to p = 2^-64. next_1d() < p would be true as often as
    /// 2^-24 even where p is 1e-30, and what goes on by roulette there would weigh 1e30.
    bool next_bool(float p) { return static_cast<float>(next_bits()) * 0x1p-64f < p; }
    /// Unit-mean exponential variate, from 3e-20 to 45.
    float next_exponential() { return exponential(next_bits()); }

    float stratified_1d(uint32_t dimension) const { return unit_float(point(dimension).x); }
    Vec2f stratified_2d(uint32_t dimension) const {
        const SobolPoint p = point(dimension);
        return {unit_float(p.x), unit_float(p.y)};
    }
    /// 64 bits of which the upper 32 are the point's first coordinate and the rest independent, for exponential
    /// variates.
    uint64_t stratified_bits(uint32_t dimension) const {
        return static_cast<uint64_t>(point(dimension).x) << 32 | (hash64(stream_, dimension) & 0xffffffffu);
    }

    uint32_t index() const { return index_; }

  private:
    SobolPoint point(uint32_t dimension) const {
        return owen_sobol(index_, hash64(scramble_, dimension, kDimensionStream));
    }

    static constexpr uint64_t kDimensionStream = 0x5e7; // keeps the scrambles' keys apart from the streams'
    uint64_t scramble_, stream_, step_, counter_ = 0;
    uint32_t index_;
};

} // namespace glimmer
