// SPDX-License-Identifier: GPL-3.0-or-later
#include "api/calls.h"

#include <array>
#include <cstring>
#include <vector>

namespace glimmer {

void create_render(Input &in, Handles &handles, glimmer_scene *scene) {
    glimmer_render_desc desc;
    glimmer_render_init(&desc);
    constexpr std::array<const char *, 5> integrators{"path", "baseline", "report", "", "none"};
    desc.integrator = in.PickValueInArray(integrators);
    desc.samples = in.ConsumeIntegralInRange<uint64_t>(0, 20); // a plan of adaptive sampling is made at 16
    desc.seconds = in.ConsumeBool() ? 0.01 : in.number();
    desc.target_error = in.ConsumeBool() ? 0 : in.number();
    desc.seed = in.ConsumeIntegral<uint64_t>();
    desc.adaptive = desc.seed & 1;
    desc.full_kernel = desc.seed >> 1 & 1;
    desc.threads = in.ConsumeIntegralInRange<uint32_t>(1, 3);
    desc.tile_size = in.ConsumeBool() ? in.ConsumeIntegralInRange<uint32_t>(0, 64) : 65537;
    desc.max_depth = in.ConsumeIntegralInRange<int64_t>(-2, 4);
    desc.max_scatter = in.ConsumeBool() ? -1 : INT64_MAX;
    const auto passes = in.ConsumeIntegralInRange<uint64_t>(0, uint64_t(1) << GLIMMER_PASS_COUNT);
    desc.passes = uint32_t(passes);
    desc.passes_above = uint32_t(passes >> 32);
    in.spoil_size(desc);
    glimmer_render *render = nullptr;
    handles.keep(glimmer_render_create(scene, &desc, &render), render, handles.renders);
}

void read(Input &in, glimmer_render *render) {
    std::vector<float> pixels(size_t(kMostSide) * kMostSide * 3, -7);
    const auto pass = in.choice<glimmer_pass>(GLIMMER_PASS_COUNT);
    uint32_t rectangle[4];
    for (uint32_t &edge : rectangle)
        edge = in.ConsumeIntegralInRange<int>(0, 7) ? in.ConsumeIntegralInRange<uint32_t>(0, kMostSide) : in.integer();
    const auto *info = glimmer_pass_info(static_cast<uint32_t>(pass));
    const size_t channels = info ? std::strlen(info->channels) : 1;
    const size_t count = in.ConsumeIntegralInRange<int>(0, 7) ? size_t(rectangle[2]) * rectangle[3] * channels
                                                              : in.ConsumeIntegralInRange<size_t>(0, pixels.size());
    const glimmer_result result = expect(glimmer_render_read(render, pass, rectangle[0], rectangle[1], rectangle[2],
                                                             rectangle[3], pixels.data(), count));
    for (size_t i = result == GLIMMER_OK ? count : 0; i < pixels.size(); ++i)
        require(pixels[i] == -7, "a value beyond the rectangle, or of a failed call");
}

void save(glimmer_render *render, std::string &state) {
    const void *data = nullptr;
    size_t size = 0;
    if (expect(glimmer_render_save(render, &data, &size)) == GLIMMER_OK)
        state.assign(static_cast<const char *>(data), size);
}

void load(Input &in, glimmer_render *render, const std::string &saved) {
    std::string state = saved;
    if (in.ConsumeBool())
        state.resize(in.ConsumeIntegralInRange<size_t>(0, state.size() + 8));
    for (int i = in.ConsumeIntegralInRange<int>(0, 3); i > 0 && !state.empty(); --i)
        state[in.ConsumeIntegralInRange<size_t>(0, std::min<size_t>(state.size(), 512) - 1)] =
            in.ConsumeIntegral<char>();
    expect(glimmer_render_load(render, in.ConsumeIntegralInRange<int>(0, 15) ? state.data() : nullptr, state.size()));
}

void control(Input &in, glimmer_render *render) {
    switch (in.ConsumeIntegralInRange<int>(0, 7)) {
    case 0:
    case 1:
        expect(glimmer_render_start(render));
        break;
    case 2:
        expect(glimmer_render_pause(render));
        break;
    case 3:
        expect(glimmer_render_resume(render));
        break;
    case 4:
        expect(glimmer_render_cancel(render));
        break;
    case 5: {
        constexpr std::array<double, 4> waits{0, 0.001, 0.01, -0.0};
        expect(glimmer_render_wait(render, in.PickValueInArray(waits)));
        break;
    }
    case 6: {
        glimmer_progress progress;
        glimmer_progress_init(&progress);
        in.spoil_size(progress);
        expect(glimmer_render_poll(render, &progress));
        break;
    }
    default: {
        glimmer_tile tile;
        int found = 0;
        expect(glimmer_render_next_tile(render, &tile, &found));
    }
    }
}

void report(glimmer_render *render) {
    const char *json = nullptr;
    if (expect(glimmer_render_report(render, &json)) == GLIMMER_OK)
        require(json && *json == '{', "a report that is none");
}

} // namespace glimmer
