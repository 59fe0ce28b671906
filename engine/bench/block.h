// SPDX-License-Identifier: GPL-3.0-or-later
// Camera samples of one block of pixels, for benchmarks of the path integrator.
#pragma once

#include "camera/camera_sample.h"
#include "integrator/path/kernels.h"
#include "integrator/path/path_integrator.h"
#include "sampling/dimensions.h"

#include <benchmark/benchmark.h>

namespace glimmer {

/// A scene with one wave and one block of it prepared.
struct BlockWorld {
    BlockWorld(const SceneDescription &description, const Rectangle &pixels_) : scene(description, 0), pixels(pixels_) {
        if (integrator->shares()) {
            wave = integrator->prepare_wave(1, 0, trace);
            block = integrator->prepare_block(*wave, pixels, trace);
        }
    }
    const LightVertexBlock *light_vertices() const { return static_cast<const LightVertexBlock *>(block.get()); }

    Scene scene;
    Rectangle pixels;
    std::unique_ptr<const Integrator> integrator = make_path_integrator(scene, {}, {});
    TraceContext trace;
    std::unique_ptr<const WaveData> wave;
    std::unique_ptr<const BlockData> block;
};

/// Sample number `index` of all pixels of the block, by trace(camera ray, sampler) -> FilmSample.
template <class Trace>
Rgb block_sum(const BlockWorld &w, uint32_t index, const Trace &trace) {
    Rgb sum;
    for (uint32_t y = w.pixels.y; y < w.pixels.y + w.pixels.height; ++y)
        for (uint32_t x = w.pixels.x; x < w.pixels.x + w.pixels.width; ++x) {
            Sampler sampler(1, x, y, 0, index);
            sum += trace(sample_camera_ray(w.scene, x, y, sampler.stratified_2d(dimension(Dimension::film)),
                                           sampler.stratified_2d(dimension(Dimension::lens)), {}),
                         sampler)
                       .radiance();
        }
    return sum;
}

template <class Trace>
void run_block(benchmark::State &state, const BlockWorld &w, const Trace &trace) {
    uint32_t index = 0;
    for (auto _ : state)
        benchmark::DoNotOptimize(block_sum(w, index++, trace));
    state.SetItemsProcessed(state.iterations() * w.pixels.width * w.pixels.height);
}

/// Whether both give the same bits.
template <class A, class B>
bool same_bits(const BlockWorld &w, const A &a, const B &b) {
    for (uint32_t index = 0; index < 16; ++index)
        if (!(block_sum(w, index, a) == block_sum(w, index, b)))
            return false;
    return true;
}

} // namespace glimmer
