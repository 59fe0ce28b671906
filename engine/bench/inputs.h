// SPDX-License-Identifier: GPL-3.0-or-later
// What the benchmarks of small functions are given: inputs that fit in the cache.
#pragma once

#include "math/vec.h"
#include "sampling/hash.h"

#include <array>
#include <benchmark/benchmark.h>
#include <cmath>

namespace glimmer {

inline constexpr size_t kInputs = 1024;

inline float uniform(uint64_t seed, uint64_t i) {
    return float(hash64(seed, i) >> 40) * 0x1p-24f;
}

/// Unit vectors with z > 0.
inline std::array<Vec3f, kInputs> upper_directions(uint64_t seed) {
    std::array<Vec3f, kInputs> out;
    for (size_t i = 0; i < kInputs; ++i) {
        const float z = 0.01f + 0.99f * uniform(seed, 2 * i), phi = 6.2831853f * uniform(seed, 2 * i + 1);
        const float r = std::sqrt(1 - z * z);
        out[i] = {r * std::cos(phi), r * std::sin(phi), z};
    }
    return out;
}

/// f(i) over all inputs, as calls a second.
template <class F>
void run(benchmark::State &state, const F &f, int64_t per_call = 1) {
    for (auto _ : state)
        for (size_t i = 0; i < kInputs; ++i)
            benchmark::DoNotOptimize(f(i));
    state.SetItemsProcessed(state.iterations() * int64_t(kInputs) * per_call);
}

} // namespace glimmer
