// SPDX-License-Identifier: GPL-3.0-or-later
// The small functions of the path loop, one call at a time over inputs that fit in the cache.
#include "bsdf/conductor.h"
#include "light/line_sampler.h"
#include "math/simd.h"
#include "sampling/hash.h"

#include <array>
#include <benchmark/benchmark.h>
#include <cmath>

namespace glimmer {
namespace {

constexpr size_t kInputs = 1024;

float uniform(uint64_t seed, uint64_t i) {
    return float(hash64(seed, i) >> 40) * 0x1p-24f;
}

std::array<Vec3f, kInputs> upper_directions(uint64_t seed) {
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

Conductor copper() {
    Conductor lobe;
    lobe.alpha = 0.25f;
    lobe.eta = {2.6f, 2.4f, 2.2f};
    lobe.k = {3.3f, 3.1f, 2.9f};
    return lobe;
}

void fresnel_of_conductor(benchmark::State &state) {
    const Conductor lobe = copper();
    const auto wo = upper_directions(1);
    run(state, [&](size_t i) { return fresnel_conductor(wo[i].z, lobe.eta, lobe.k); });
}
BENCHMARK(fresnel_of_conductor);

void ggx_eval(benchmark::State &state) {
    const Conductor lobe = copper();
    const auto wo = upper_directions(1), wi = upper_directions(2);
    run(state, [&](size_t i) { return eval(lobe, wo[i], wi[i]); });
}
BENCHMARK(ggx_eval);

void ggx_sample(benchmark::State &state) {
    const Conductor lobe = copper();
    const auto wo = upper_directions(1);
    run(state, [&](size_t i) { return sample(lobe, wo[i], {uniform(3, i), uniform(4, i)}); });
}
BENCHMARK(ggx_sample);

void line_table(benchmark::State &state) {
    const Homogeneous medium(Rgb(0.0015f), Rgb(0.0135f), 0);
    const auto direction = upper_directions(1), place = upper_directions(2);
    run(state, [&](size_t i) {
        const LineSampler line(medium, {0, 0, 0}, direction[i], 100, place[i] * 30, 2);
        return line.sample(uniform(3, i));
    });
}
BENCHMARK(line_table);

void exp_of_eight(benchmark::State &state) {
    std::array<float, kInputs + 8> x;
    for (size_t i = 0; i < x.size(); ++i)
        x[i] = -20 * uniform(1, i);
    run(
        state, [&](size_t i) { return exp(Float8::load(&x[i])); }, 8);
}
BENCHMARK(exp_of_eight);

} // namespace
} // namespace glimmer
