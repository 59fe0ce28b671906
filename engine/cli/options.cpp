// SPDX-License-Identifier: GPL-3.0-or-later
#include "options.h"

#include "errors.h"
#include "information.h"
#include "picture/picture_file.h"
#include "text.h"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <charconv>
#include <cmath>
#include <limits>
#include <set>

namespace glimmer {
namespace {

constexpr uint64_t kMostSamples = 2147483647; // what the picture's metadata can hold

/// The whole text as a number, or the error that names the option and what it allows.
uint64_t integer_option(const std::string &option, const std::string &text, uint64_t low, uint64_t high) {
    uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < low || value > high)
        throw InputError(option + ": " + in_quotes(text) + " is not an integer from " + std::to_string(low) + " to " +
                         std::to_string(high));
    return value;
}
double positive_option(const std::string &option, const std::string &text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !(value > 0) || std::isinf(value))
        throw InputError(option + ": " + in_quotes(text) + " is not a number above 0");
    return value;
}

uint64_t pass_bits(const std::string &text) {
    uint64_t bits = 0;
    for (size_t at = 0; at <= text.size();) {
        const size_t end = std::min(text.find(',', at), text.size());
        const auto names = pass_names();
        const auto found = std::find(names.begin(), names.end(), text.substr(at, end - at));
        if (found == names.end())
            throw InputError("--aov: " + in_quotes(text.substr(at, end - at)) +
                             " is not an AOV; see glimmer --list-aovs");
        bits |= 1ull << (found - names.begin());
        at = end + 1;
    }
    return bits;
}

void expect_integrator(const std::string &name) {
    const auto names = integrator_names();
    if (std::find(names.begin(), names.end(), name) == names.end() && renamed_integrator(name).empty())
        throw InputError("--integrator: " + in_quotes(name) + " is not an integrator; integrators are " +
                         quoted_list(names));
}

/// A place to write to: known ending, existing folder, not a folder itself. Found out before hours of rendering.
void expect_writable(const std::string &option, const std::filesystem::path &path,
                     std::initializer_list<std::string_view> endings) {
    if (endings.size() != 0 && std::find(endings.begin(), endings.end(), lower_extension(path)) == endings.end()) {
        std::string allowed;
        for (size_t i = 0; i < endings.size(); ++i)
            allowed += (i == 0 ? "" : i + 1 == endings.size() ? " or " : ", ") + std::string(endings.begin()[i]);
        throw InputError(option + ": " + in_quotes(path.string()) + " does not end in " + allowed);
    }
    std::error_code error;
    if (!std::filesystem::is_directory(path.has_parent_path() ? path.parent_path() : ".", error))
        throw InputError(option + ": " + in_quotes(path.string()) + ": no such folder");
    if (std::filesystem::is_directory(path, error))
        throw InputError(option + ": " + in_quotes(path.string()) + " is a folder; a file is allowed");
}

/// CLI11 with its errors as ours: exit status 1 and one line.
void parse(CLI::App &app, std::vector<std::string> arguments) {
    try {
        std::reverse(arguments.begin(), arguments.end()); // as the library wants them
        app.parse(std::move(arguments));
    } catch (const CLI::CallForHelp &) {
        throw;
    } catch (const CLI::ParseError &error) {
        std::string message = error.what();
        std::replace(message.begin(), message.end(), '\n', ' ');
        throw InputError("glimmer: " + message + "; see glimmer --help");
    }
}

MergeOptions parse_merge(const std::vector<std::string> &arguments, std::optional<Information> &help) {
    MergeOptions options;
    std::vector<std::string> inputs;
    std::string output;
    CLI::App app("Joins renders of one scene with different seeds into one: the mean of all their samples.",
                 "glimmer merge");
    app.add_option("PICTURE", inputs, "two or more .exr files that glimmer wrote")
        ->required()
        ->expected(-1) // the library's help would tell two from more as "x 2"
        ->type_name("A.exr B.exr");
    app.add_option("-o,--output", output, "the .exr to write")->required()->type_name("C.exr");
    try {
        parse(app, arguments);
    } catch (const CLI::CallForHelp &) {
        help = Information{app.help()};
        return options;
    }
    if (inputs.size() < 2)
        throw InputError("merge: " + in_quotes(inputs[0]) + " is one picture; two or more can be merged");
    options.inputs.assign(inputs.begin(), inputs.end());
    options.output = output;
    expect_writable("-o", options.output, {".exr"});
    return options;
}

/// Two results in one file would leave only the last.
void expect_different_files(const RenderOptions &options) {
    std::set<std::filesystem::path> seen;
    for (const auto &path : {std::optional(options.scene), std::optional(options.output), options.checkpoint,
                             options.report, options.curve})
        if (path && !seen.insert(std::filesystem::weakly_canonical(std::filesystem::absolute(*path))).second)
            throw InputError("glimmer: " + in_quotes(path->string()) +
                             " is named twice; scene and results are different files");
}

} // namespace

Options parse_options(int argc, char **argv) {
    std::vector<std::string> arguments(argv + 1, argv + argc);
    if (!arguments.empty() && arguments[0] == "farm")
        return FarmOptions{{arguments.begin() + 1, arguments.end()}};
    if (!arguments.empty() && arguments[0] == "merge") {
        arguments.erase(arguments.begin());
        std::optional<Information> help;
        auto options = parse_merge(arguments, help);
        return help ? Options(*help) : Options(std::move(options));
    }

    RenderOptions options;
    std::string scene, output, spp, time, error, integrator, seed, threads, tile, aov, checkpoint, interval, report,
        curve;
    bool version = false, list_integrators = false, list_aovs = false;
    CLI::App app(
        "Renders a scene file. \"glimmer merge --help\" tells how to join pictures, \"glimmer farm --help\" how to "
        "render by many machines.",
        "glimmer");
    app.add_option("SCENE", scene, "the scene file (.json)");
    app.add_option("-o,--output", output, "picture to write: .exr (everything), .png, .pfm or .hdr")->type_name("FILE");
    app.add_option("--spp", spp, "stop at N samples a pixel (64 when no limit is given)")->type_name("N");
    app.add_option("--time", time, "stop after this much rendering")->type_name("SECONDS");
    app.add_option("--error", error, "stop when the relMSE is below this with confidence")->type_name("RELMSE");
    app.add_flag("--adaptive", options.adaptive,
                 "more samples where the picture needs them, fewer elsewhere; --spp is the mean");
    app.add_flag("--independent-pixels", options.independent_pixels,
                 "samples count for one pixel each, as denoisers need it: more noise, none of it shared");
    app.add_flag("--full-kernel", options.full_kernel,
                 "run the code for all scenes, not what was compiled for ones like this: slower, the same bits");
    app.add_option("--integrator", integrator, "method; see --list-integrators")->type_name("NAME");
    app.add_option("--seed", seed, "another seed gives independent noise (default 0)")->type_name("N");
    app.add_option("--threads", threads, "worker threads (default: all cores)")->type_name("N");
    app.add_option("--tile", tile, "tile size in pixels; changes no pixel")->type_name("N");
    app.add_option("--aov", aov, "extra layers of the .exr, separated by commas; see --list-aovs")
        ->type_name("NAME,...");
    app.add_option("--checkpoint", checkpoint, "go on from FILE if it is there; keep it up to date")->type_name("FILE");
    app.add_option("--checkpoint-interval", interval, "save to it this often (default 30)")->type_name("SECONDS");
    app.add_option("--report", report, "JSON with times, error, curve, warnings")->type_name("OUT.json");
    app.add_option("--curve", curve, "error against run time, as a table or a plot")->type_name("OUT.csv|.png");
    app.add_flag("--quiet", options.quiet, "no progress on the standard error");
    app.add_flag("--version", version, "print the version");
    app.add_flag("--list-integrators", list_integrators, "print the integrators");
    app.add_flag("--list-aovs", list_aovs, "print the AOVs");
    try {
        parse(app, arguments);
    } catch (const CLI::CallForHelp &) {
        return Information{app.help()};
    }
    if (version)
        return Information{version_text()};
    if (list_integrators)
        return Information{integrator_list()};
    if (list_aovs)
        return Information{aov_list()};

    const auto given = [&](const char *name) { return app.count(name) > 0; };
    if (scene.empty())
        throw InputError("glimmer: the scene file is missing; see glimmer --help");
    if (output.empty())
        throw InputError("glimmer: -o OUT is missing; .exr, .png, .pfm and .hdr are allowed");
    options.scene = scene;
    options.output = output;
    expect_writable("-o", options.output, {".exr", ".png", ".pfm", ".hdr"});
    if (given("--spp"))
        options.samples = integer_option("--spp", spp, 1, kMostSamples);
    if (given("--time"))
        options.seconds = positive_option("--time", time);
    if (given("--error"))
        options.target_error = positive_option("--error", error);
    if (given("--integrator"))
        expect_integrator(options.integrator = integrator);
    if (given("--seed"))
        options.seed = integer_option("--seed", seed, 0, UINT64_MAX);
    if (given("--threads"))
        options.threads = static_cast<uint32_t>(integer_option("--threads", threads, 1, 4096));
    if (given("--tile"))
        options.tile = static_cast<uint32_t>(integer_option("--tile", tile, 1, 65536));
    if (given("--aov")) {
        options.passes = pass_bits(aov);
        if (lower_extension(options.output) != ".exr")
            throw InputError("--aov: " + in_quotes(output) + " has no layers; only .exr has");
    }
    const auto file_option = [&](const char *name, const std::string &text,
                                 std::initializer_list<std::string_view> endings) {
        std::optional<std::filesystem::path> path;
        if (given(name))
            expect_writable(name, *(path = text), endings);
        return path;
    };
    options.checkpoint = file_option("--checkpoint", checkpoint, {});
    if (given("--checkpoint-interval")) {
        if (!options.checkpoint)
            throw InputError("--checkpoint-interval: there is no --checkpoint FILE to save to");
        options.checkpoint_seconds = positive_option("--checkpoint-interval", interval);
    }
    options.report = file_option("--report", report, {".json"});
    options.curve = file_option("--curve", curve, {".csv", ".png"});
    expect_different_files(options);
    return options;
}

} // namespace glimmer
