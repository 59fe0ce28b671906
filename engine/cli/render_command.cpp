// SPDX-License-Identifier: GPL-3.0-or-later
#include "render_command.h"

#include "checkpoint.h"
#include "information.h"
#include "interrupt.h"
#include "picture/atomic_file.h"
#include "picture/picture_file.h"
#include "picture/read_render.h"
#include "progress.h"
#include "report/curve.h"
#include "report/report.h"
#include "scene_file/scene_file.h"
#include "text.h"

#include <chrono>
#include <cstdio>
#include <sstream>

namespace glimmer {
namespace {

constexpr double kPollSeconds = 0.05;
constexpr double kNoLimit = -1;

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

RenderHandle create_render(glimmer_scene *scene, const DepthLimits &limits, const RenderOptions &options) {
    glimmer_render_desc desc;
    glimmer_render_init(&desc);
    desc.integrator = options.integrator.empty() ? nullptr : options.integrator.c_str();
    desc.samples = options.samples;
    desc.seconds = options.seconds;
    desc.target_error = options.target_error;
    desc.seed = options.seed;
    desc.threads = options.threads;
    desc.tile_size = options.tile;
    desc.adaptive = options.adaptive;
    desc.independent_pixels = options.independent_pixels;
    desc.full_kernel = options.full_kernel;
    desc.max_depth = limits.max_depth;
    desc.max_scatter = limits.max_scatter;
    desc.passes = uint32_t(options.passes) | 1u << GLIMMER_PASS_COMBINED | 1u << GLIMMER_PASS_STDERR;
    desc.passes_above = uint32_t(options.passes >> 32);
    glimmer_render *render = nullptr;
    check(glimmer_render_create(scene, &desc, &render), options.scene.string());
    return RenderHandle(render);
}

glimmer_progress poll(glimmer_render *render) {
    glimmer_progress progress;
    glimmer_progress_init(&progress);
    check(glimmer_render_poll(render, &progress), "render");
    return progress;
}

bool ended(const glimmer_progress &progress) {
    return progress.state != GLIMMER_RUNNING && progress.state != GLIMMER_PAUSED;
}

/// Says once why a render whose error seems small enough goes on.
void explain_going_on(const RenderOptions &options, const glimmer_progress &progress, bool &said, ProgressLine &line) {
    if (said || !progress.heavy_tails || !(progress.relmse_high <= options.target_error))
        return;
    said = true;
    line.say(options.output.string() + ": " + error_text(progress) + " seems to meet --error " +
             number_text(options.target_error) + " but is " + tails_text(progress) + "; the render goes on" +
             (options.samples || options.seconds > 0
                  ? ""
                  : ", without other limits until it is certifiable or interrupted"));
}

/// Waits for the end while it shows the progress, saves checkpoints and listens for SIGINT.
void follow(glimmer_render *render, const RenderOptions &options, const std::string &scene_hash, ProgressLine &line) {
    bool said = false;
    Clock::time_point last_checkpoint = Clock::now();
    for (glimmer_progress progress = poll(render); !ended(progress); progress = poll(render)) {
        line.update(progress);
        explain_going_on(options, progress, said, line);
        if (interrupted()) {
            check(glimmer_render_cancel(render), "render");
            break;
        }
        if (options.checkpoint && seconds_since(last_checkpoint) >= options.checkpoint_seconds) {
            check(glimmer_render_pause(render), "render");
            if (!ended(poll(render))) {
                save_checkpoint(*options.checkpoint, scene_hash, render);
                check(glimmer_render_resume(render), "render");
            }
            last_checkpoint = Clock::now();
        }
        check(glimmer_render_wait(render, kPollSeconds), "render");
    }
    check(glimmer_render_wait(render, kNoLimit), "render");
    if (options.checkpoint)
        save_checkpoint(*options.checkpoint, scene_hash, render);
}

/// Warnings of the engine, one a line.
void show_warnings(glimmer_scene *scene, const std::string &file, ProgressLine &line) {
    std::istringstream warnings(glimmer_scene_warnings(scene));
    for (std::string warning; std::getline(warnings, warning);)
        line.say(file + ": warning: " + warning);
}

/// "adaptive sampling: pixels took 16 to 210 samples", or "".
std::string adaptive_text(const Report &report) {
    const Report counts = report.value("adaptive", Report());
    if (!counts.is_object())
        return "";
    return "adaptive sampling: pixels took " + counts["fewest"].dump() + " to " + counts["most"].dump() + " samples";
}

std::string summary(const RenderOptions &options, const glimmer_progress &progress, const Report &report) {
    char seconds[32];
    std::snprintf(seconds, sizeof seconds, "%.2f s", progress.seconds);
    std::string text = options.output.string() + ": " + std::to_string(progress.samples) + " spp in " + seconds;
    for (const std::string &part :
         {error_text(progress), tails_text(progress), rate_text(progress), adaptive_text(report)})
        if (!part.empty())
            text += ", " + part;
    return text;
}

void write_results(const RenderOptions &options, const LoadedScene &scene, glimmer_render *render,
                   const glimmer_progress &progress, const Report &report) {
    Picture picture = read_render(render, scene.film, options.passes, progress.samples >= 2);
    picture.info = {progress.samples,
                    {std::to_string(options.seed)},
                    progress.seconds,
                    glimmer_version(),
                    scene.hash,
                    report.value("integrator", std::string()),
                    report_texts(report, "biased_by")};
    // The picture last: where it stands, all is there.
    if (options.report)
        write_file(*options.report, report.dump(2) + "\n");
    if (options.curve)
        write_curve(curve_of(report), *options.curve);
    write_picture(picture, options.output);
}

} // namespace

int run_render(const RenderOptions &options) {
    catch_interrupts();
    ProgressLine line(options.quiet);

    const auto load_start = Clock::now();
    const std::string file = options.scene.string();
    LoadedScene scene = load_scene(options.scene);
    const double load_seconds = seconds_since(load_start);

    const auto build_start = Clock::now();
    check(glimmer_scene_commit(scene.scene.get(), options.threads), file);
    const double build_seconds = seconds_since(build_start);
    show_warnings(scene.scene.get(), file, line);

    const RenderHandle render = create_render(scene.scene.get(), scene.limits, options);
    if (const std::string present = renamed_integrator(options.integrator); !present.empty())
        line.say("--integrator: warning: " + in_quotes(options.integrator) + " is now called " + in_quotes(present));
    expect_writable(options.output);
    if (options.curve)
        expect_writable(*options.curve);
    if (options.checkpoint && load_checkpoint(*options.checkpoint, scene.hash, render.get()))
        line.say(options.checkpoint->string() + ": going on from " + std::to_string(poll(render.get()).samples) +
                 " spp");
    if (!interrupted()) {
        check(glimmer_render_start(render.get()), "render");
        follow(render.get(), options, scene.hash, line);
    }

    const glimmer_progress progress = poll(render.get());
    if (progress.samples == 0) {
        if (!interrupted())
            throw ResultError(options.output.string() + ": not written: the render ended before its first sample");
        line.complain(options.output.string() + ": not written: interrupted before the first sample was finished");
        return kInterrupted;
    }
    const Report report = make_report(render.get(), load_seconds, build_seconds, scene.left_out);
    write_results(options, scene, render.get(), progress, report);
    const bool cut_short = progress.state != GLIMMER_FINISHED;
    line.say(summary(options, progress, report) + (cut_short ? " (interrupted)" : ""));
    return cut_short ? kInterrupted : kDone;
}

} // namespace glimmer
