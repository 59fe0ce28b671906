// SPDX-License-Identifier: GPL-3.0-or-later
// Fuzzes the scene reader: the input is the JSON, beside the files of the folder that GLIMMER_FUZZ_FOLDER names. What
// loads is committed, and rendered for a moment where the picture is small. Either that works or an error of one line
// says why.
#include "fuzz.h"
#include "handles.h"
#include "scene_file/scene_file.h"

#include <fstream>
#include <unistd.h>

namespace glimmer {
namespace {

constexpr uint32_t kMostPixels = 4096;
constexpr double kMostSeconds = 0.2;

void render(glimmer_scene *scene, const DepthLimits &limits, const char *integrator) {
    glimmer_render_desc desc;
    glimmer_render_init(&desc);
    desc.integrator = integrator;
    desc.samples = 2;
    desc.threads = 1;
    desc.max_depth = limits.max_depth;
    desc.max_scatter = limits.max_scatter;
    desc.passes = (uint32_t(1) << GLIMMER_PASS_LIGHT_GROUP) - 1; // those of light groups do without light vertices
    glimmer_render *handle = nullptr;
    check(glimmer_render_create(scene, &desc, &handle), "render");
    const RenderHandle render(handle);
    check(glimmer_render_start(handle), "render");
    check(glimmer_render_wait(handle, kMostSeconds), "render");
    check(glimmer_render_cancel(handle), "render");
    check(glimmer_render_wait(handle, -1), "render");
}

void load(const std::filesystem::path &file) {
    LoadedScene scene = load_scene(file);
    if (uint64_t(scene.film.width) * scene.film.height > kMostPixels)
        return;
    check(glimmer_scene_commit(scene.scene.get(), 1), "scene");
    for (const char *integrator : {"path", "baseline"})
        render(scene.scene.get(), scene.limits, integrator);
}

void try_load(const std::filesystem::path &file) {
    try {
        load(file);
    } catch (const InputError &error) {
        expect_one_line(error.what());
    } catch (const ResultError &error) {
        expect_one_line(error.what());
    }
}

} // namespace
} // namespace glimmer

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static const char *folder = std::getenv("GLIMMER_FUZZ_FOLDER");
    glimmer::require(folder != nullptr, "GLIMMER_FUZZ_FOLDER is not set");
    static const auto file = std::filesystem::path(folder) / ("fuzz-" + std::to_string(getpid()) + ".json");
    std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char *>(data), std::streamsize(size));
    glimmer::expect_no_leak([] { glimmer::try_load(file); });
    return 0;
}
