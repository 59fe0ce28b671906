// SPDX-License-Identifier: GPL-3.0-or-later
// Renders.
#include "api/handles.h"

using namespace glimmer;

namespace {

uint32_t checked_integrator(const char *name) {
    if (!name || !*name)
        return 0;
    if (const auto index = find_integrator(name))
        return *index;
    std::string known;
    for (const auto &integrator : kIntegrators)
        known += std::string(known.empty() ? "" : ", ") + integrator.name;
    fail_argument("integrator \"" + std::string(name) + "\" is not known; allowed: " + known);
}

uint32_t depth_limit(int64_t value, const char *what) {
    if (value < -1)
        fail_argument(std::string("render: ") + what + " is " + std::to_string(value) +
                      "; allowed: -1 (no limit) and up");
    constexpr auto most = std::numeric_limits<uint32_t>::max();
    return value < 0 || value >= int64_t(most) ? most : uint32_t(value);
}

} // namespace

extern "C" {

void glimmer_render_init(glimmer_render_desc *desc) {
    if (!desc)
        return;
    *desc = {};
    desc->struct_size = sizeof *desc;
    desc->max_depth = desc->max_scatter = -1;
    desc->passes = 1u << GLIMMER_PASS_COMBINED;
}

glimmer_result glimmer_render_create(glimmer_scene *scene, const glimmer_render_desc *desc, glimmer_render **render) {
    return guarded([&] {
        glimmer_scene &s = checked(scene, "scene");
        if (!s.scene)
            fail_state("the scene is not committed");
        if (!render)
            fail_argument("render: the output is null");
        glimmer_render_desc defaults;
        glimmer_render_init(&defaults);
        const glimmer_render_desc d = checked_desc(desc, defaults, "render");
        check_range(d.seconds, 0, HUGE_VAL, "render: seconds");
        check_range(d.target_error, 0, HUGE_VAL, "render: target_error");
        check_range(d.threads, 0, 4096, "render: threads");
        check_range(d.tile_size, 0, 65536, "render: tile_size");
        const uint64_t passes = d.passes | uint64_t(d.passes_above) << 32;
        if (passes >> GLIMMER_PASS_COUNT)
            fail_argument("render: passes_above has bits above pass " + std::to_string(GLIMMER_PASS_COUNT - 1));
        RenderSettings settings;
        settings.integrator = checked_integrator(d.integrator);
        if (const std::string renamed = renamed_integrator(d.integrator ? d.integrator : ""); !renamed.empty())
            settings.warnings.push_back({GLIMMER_WARNING_RENAMED_INTEGRATOR, renamed});
        settings.samples = d.samples;
        settings.seconds = d.seconds;
        settings.target_error = d.target_error;
        settings.seed = d.seed;
        settings.threads = d.threads;
        settings.tile_size = d.tile_size ? (d.tile_size + kBlockSize - 1) / kBlockSize * kBlockSize : 64;
        settings.passes = passes | bit_of(GLIMMER_PASS_COMBINED);
        if (s.scene->film.transparent)
            settings.passes |= bit_of(GLIMMER_PASS_ALPHA);
        settings.limits = {depth_limit(d.max_depth, "max_depth"), depth_limit(d.max_scatter, "max_scatter")};
        settings.adaptive = d.adaptive != 0;
        settings.independent_pixels = d.independent_pixels != 0;
        settings.full_kernel = d.full_kernel != 0;
        auto handle = std::make_unique<glimmer_render>();
        handle->session = std::make_unique<Session>(s.scene, settings);
        *render = handle.release();
    });
}

void glimmer_render_destroy(glimmer_render *render) {
    destroy(render);
}

glimmer_result glimmer_render_start(glimmer_render *render) {
    return guarded([&] { checked(render, "render").session->start(); });
}

glimmer_result glimmer_render_pause(glimmer_render *render) {
    return guarded([&] { checked(render, "render").session->pause(); });
}

glimmer_result glimmer_render_resume(glimmer_render *render) {
    return guarded([&] { checked(render, "render").session->resume(); });
}

glimmer_result glimmer_render_cancel(glimmer_render *render) {
    return guarded([&] { checked(render, "render").session->cancel(); });
}

glimmer_result glimmer_render_wait(glimmer_render *render, double seconds) {
    return guarded([&] { checked(render, "render").session->wait(seconds); });
}

void glimmer_progress_init(glimmer_progress *progress) {
    if (!progress)
        return;
    *progress = {};
    progress->struct_size = sizeof *progress;
}

glimmer_result glimmer_render_poll(glimmer_render *render, glimmer_progress *progress) {
    return guarded([&] {
        glimmer_render &r = checked(render, "render");
        if (!progress || !known_size<glimmer_progress>(progress->struct_size))
            fail_argument("progress: the output is null or was not initialised");
        const glimmer_progress p = r.session->progress();
        const size_t size = progress->struct_size;
        std::memcpy(static_cast<void *>(progress), &p, size);
        progress->struct_size = size;
    });
}

glimmer_result glimmer_render_next_tile(glimmer_render *render, glimmer_tile *tile, int *found) {
    return guarded([&] {
        glimmer_render &r = checked(render, "render");
        if (!tile || !found)
            fail_argument("next_tile: an output is null");
        *found = r.session->next_tile(*tile) ? 1 : 0;
    });
}

glimmer_result glimmer_render_read(glimmer_render *render, glimmer_pass pass, uint32_t x, uint32_t y, uint32_t width,
                                   uint32_t height, float *pixels, size_t value_count) {
    return guarded([&] {
        const Film &film = checked(render, "render").session->film();
        if (uint32_t(pass) >= GLIMMER_PASS_COUNT)
            fail_argument("read: pass " + std::to_string(int(pass)) + " is not known; allowed: 0 to " +
                          std::to_string(GLIMMER_PASS_COUNT - 1));
        if (!is_always_there(pass) && !(film.passes() & bit_of(pass)))
            fail_argument(std::string("read: the pass \"") + kPasses[pass].info.name +
                          "\" was not asked for when the render was made");
        if (x > film.width() || width > film.width() - x || y > film.height() || height > film.height() - y)
            fail_argument("read: the rectangle leaves the picture of " + std::to_string(film.width()) + " x " +
                          std::to_string(film.height()));
        const size_t wanted = size_t(width) * height * pass_channels(pass);
        if (value_count != wanted)
            fail_argument("read: value_count is " + std::to_string(value_count) + "; this rectangle and pass have " +
                          std::to_string(wanted));
        if (!pixels && wanted)
            fail_argument("read: pixels is null");
        film.read(pass, {x, y, width, height}, pixels);
    });
}

glimmer_result glimmer_render_report(glimmer_render *render, const char **json) {
    return guarded([&] {
        glimmer_render &r = checked(render, "render");
        if (!json)
            fail_argument("report: the output is null");
        r.report = r.session->report();
        *json = r.report.c_str();
    });
}

glimmer_result glimmer_render_save(glimmer_render *render, const void **data, size_t *size) {
    return guarded([&] {
        glimmer_render &r = checked(render, "render");
        if (!data || !size)
            fail_argument("save: an output is null");
        r.state = r.session->save();
        *data = r.state.data();
        *size = r.state.size();
    });
}

glimmer_result glimmer_render_load(glimmer_render *render, const void *data, size_t size) {
    return guarded([&] {
        glimmer_render &r = checked(render, "render");
        if (!data)
            fail_argument("load: data is null");
        r.session->load(static_cast<const uint8_t *>(data), size);
    });
}
}
