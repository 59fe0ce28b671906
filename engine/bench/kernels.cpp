// SPDX-License-Identifier: GPL-3.0-or-later
// The small functions of the path loop, one call at a time over inputs that fit in the cache.
#include "bsdf/conductor.h"
#include "inputs.h"
#include "integrator/vpl/connect_simd.h"
#include "light/equiangular_table.h"
#include "math/simd/float8.h"

#include <array>
#include <benchmark/benchmark.h>
#include <vector>

namespace glimmer {
namespace {

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

void equiangular_table(benchmark::State &state) {
    const HomogeneousMedium medium(Rgb(0.0015f), Rgb(0.0135f), 0);
    const auto direction = upper_directions(1), place = upper_directions(2);
    run(state, [&](size_t i) {
        const EquiangularTable table(medium, {0, 0, 0}, direction[i], 100, place[i] * 30, 2);
        return table.sample(uniform(3, i));
    });
}
BENCHMARK(equiangular_table);

/// Connections of a gather point to the 128 vertices of a subset; argument: whether in AVX-512.
void connections(benchmark::State &state) {
    if (state.range(0) && !has_avx512())
        return state.SkipWithError("this processor has no AVX-512");
    const ConnectKernels &of_set = state.range(0) ? kConnectAvx512 : kConnectAvx2;
    constexpr size_t count = 128, subsets = 8;
    std::array<std::vector<float>, 6> columns;
    for (size_t c = 0; c < columns.size(); ++c)
        for (size_t i = 0; i < count * subsets; ++i)
            columns[c].push_back(uniform(c, i));
    std::array<float, count> parts;
    run(state, [&](size_t i) {
        const size_t first = i % subsets * count;
        const auto from = [&](size_t c) { return columns[c].data() + first; };
        return of_set.connect({0.015f, 0.015f, 0.015f, 0, true},
                              {from(0), from(1), from(2), from(3), from(4), from(5), nullptr, nullptr, nullptr}, count,
                              {uniform(7, i), 0.5f, 0.5f, 0, 0, 1}, 0.3f, {parts.data(), nullptr, nullptr, nullptr});
    });
}
BENCHMARK(connections)->Arg(0)->Arg(1);

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
