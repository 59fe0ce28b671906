// SPDX-License-Identifier: GPL-3.0-or-later
// What a kernel saves by the features that it leaves out (integrator/path/kernel_features.h): camera samples of one
// block, by the kernel that is selected for the scene, by that kernel with single features put back, and by the one for
// everything. All give the same bits, which is checked first. To run one scene: --benchmark_filter=features/field.
#include "block.h"
#include "five_moons.h"
#include "integrator/path/kernel.inl"
#include "plates.h"

#include <benchmark/benchmark.h>
#include <cmath>
#include <string>
#include <utility>

namespace glimmer {
namespace {

constexpr Rectangle kPixels{64, 64, kBlockSize, kBlockSize};

/// A field of rough metal under three moons.
SceneDescription moonlit_plates(bool medium) {
    SceneDescription scene = plates(60);
    MaterialDescription &metal = scene.materials[0];
    metal.type = MaterialType::conductor;
    metal.alternative = 1;
    metal.alpha = 0.25f;
    metal.eta = {2.6f, 2.4f, 2.2f};
    metal.k = {3.3f, 3.1f, 2.9f};
    for (uint32_t i = 0; i < 3; ++i)
        add_moon(scene, 2.1f * float(i), {-20.0 + 20 * i, 40, 12.0 + i}, 2);
    if (medium)
        scene.medium = MediumDescription{{0.001, 0.001, 0.001}, {0.005, 0.0055, 0.0065}, 0, {}};
    const double down = 0.1,
                 rows[16] = {1,   0, 0, 0, 0, std::sin(down), -std::cos(down), -4, 0, std::cos(down), std::sin(down),
                             7.5, 0, 0, 0, 1};
    std::copy(std::begin(rows), std::end(rows), scene.camera->to_world);
    scene.film->width = 192;
    scene.film->height = 128;
    return scene;
}

BlockWorld &moons() {
    static BlockWorld w(five_moons(96, 96), {32, 32, kBlockSize, kBlockSize});
    return w;
}
BlockWorld &field() {
    static BlockWorld w(moonlit_plates(false), kPixels);
    return w;
}
BlockWorld &hazy_field() {
    static BlockWorld w(moonlit_plates(true), kPixels);
    return w;
}

auto tracer(BlockWorld &w, const PathKernel &kernel) {
    return [&w, kernel, plan = plan_splitting(w.scene, kAllEstimators)](const CameraRay &camera, Sampler &sampler) {
        static constexpr DepthLimits kNoLimits;
        const PathContext context{w.scene,        kNoLimits, kAllEstimators, plan, w.light_vertices(), camera.pixel_x,
                                  camera.pixel_y, 1};
        return kernel.sample(context, camera.ray, {}, sampler, w.trace);
    };
}

void add(const std::string &scene, BlockWorld &(*world)(), const PathKernel &kernel) {
    benchmark::RegisterBenchmark(("features/" + scene + "/" + kernel.name).c_str(), [=](benchmark::State &state) {
        BlockWorld &w = world();
        if (!covers(kernel.features, needed_by(w.scene, {}, w.light_vertices() != nullptr)))
            return state.SkipWithError("the scene needs features that this kernel has not");
        if (!same_bits(w, tracer(w, kernel), tracer(w, path_kernel(kAllFeatures))))
            return state.SkipWithError("other bits than the full kernel's");
        run_block(state, w, tracer(w, kernel));
    });
}

constexpr KernelFeatures with(KernelFeatures f, size_t feature) {
    f.*kFeatureTexts[feature].feature = true;
    return f;
}

template <KernelFeatures F, size_t... I>
void add_all(const char *scene, BlockWorld &(*world)(), std::index_sequence<I...>) {
    add(scene, world, compiled<F>("selected"));
    const auto put_back = [&]<size_t i>(std::integral_constant<size_t, i>) {
        if constexpr (!(F.*kFeatureTexts[i].feature))
            add(scene, world, compiled<with(F, i)>(kFeatureTexts[i].name));
    };
    (put_back(std::integral_constant<size_t, I>()), ...);
    add(scene, world, path_kernel(kAllFeatures));
}

[[maybe_unused]] const bool added = [] {
    constexpr auto all = std::make_index_sequence<kFeatureTexts.size()>();
    add_all<KernelFeatures{.medium = true}>("moons", moons, all);
    add_all<KernelFeatures{.surfaces = true, .bvh = true}>("field", field, all);
    add_all<KernelFeatures{.medium = true, .surfaces = true, .bvh = true}>("hazy_field", hazy_field, all);
    return true;
}();

} // namespace
} // namespace glimmer
