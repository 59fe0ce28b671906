// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/report.h"

#include "render/reconstruction.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace glimmer {

namespace {

std::string number(double x) {
    if (!std::isfinite(x))
        return "null";
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", x);
    return text;
}

std::string quoted(const std::string &s) {
    std::string out = "\"";
    for (char c : s) {
        if (c == '"' || c == '\\')
            out += '\\';
        if (static_cast<unsigned char>(c) < 0x20)
            out += ' ';
        else
            out += c;
    }
    return out + "\"";
}

std::string list(const std::vector<std::string> &items) {
    std::string out;
    for (const std::string &s : items)
        out += (out.empty() ? "" : ", ") + quoted(s);
    return "[" + out + "]";
}

std::string object(std::initializer_list<std::pair<const char *, std::string>> members) {
    std::string out;
    for (const auto &[key, value] : members)
        out += (out.empty() ? "" : ", ") + quoted(key) + ": " + value;
    return "{" + out + "}";
}

std::string text(bool value) {
    return value ? "true" : "false";
}

std::string seconds_left(double seconds) {
    return seconds < 0 ? "null" : number(seconds);
}

/// Every setting and every fault that biases the picture.
std::vector<std::string> biased_by(const RenderSettings &settings, const SampleFaults &faults) {
    constexpr auto no_limit = std::numeric_limits<uint32_t>::max();
    std::vector<std::string> lines;
    if (settings.limits.depth != no_limit)
        lines.push_back("max_depth " + std::to_string(settings.limits.depth));
    if (settings.limits.scatter != no_limit)
        lines.push_back("max_scatter " + std::to_string(settings.limits.scatter));
    if (faults.invalid)
        lines.push_back(std::to_string(faults.invalid) + " invalid samples counted as black");
    if (faults.unfinished)
        lines.push_back(std::to_string(faults.unfinished) + " samples broken off on paths without end");
    return lines;
}

std::string curve_points(const std::vector<CurvePoint> &points) {
    std::string out;
    for (const CurvePoint &c : points)
        out += (out.empty() ? "[" : ", [") + number(c.seconds) + ", " + number(c.cpu_seconds) + ", " +
               std::to_string(c.samples) + ", " + number(c.error.relmse) + ", " + number(c.error.low) + ", " +
               number(c.error.high) + "]";
    return "[" + out + "]";
}

std::string error_with_tails(const ErrorEstimate &error) {
    if (!std::isfinite(error.relmse))
        return "null";
    std::string tails = "null";
    if (error.has_interval())
        tails = object({{"certifiable", text(error.certifiable())},
                        {"largest_share", number(error.largest_share)},
                        {"allowed", number(kLargestShareAllowed)},
                        {"x", std::to_string(error.x)},
                        {"y", std::to_string(error.y)}});
    return object({{"relmse", number(error.relmse)},
                   {"low", number(error.low)},
                   {"high", number(error.high)},
                   {"confidence", number(kErrorConfidence)},
                   {"tails", tails}});
}

std::string fall_rate(const FallRate &rate) {
    if (!std::isfinite(rate.power))
        return "null";
    return object({{"power", number(rate.power)},
                   {"low", number(rate.low)},
                   {"high", number(rate.high)},
                   {"confidence", number(kErrorConfidence)}});
}

std::string invalid_samples(const SampleFaults &faults) {
    std::string first = "null";
    if (faults.first)
        first = object({{"x", std::to_string(faults.first->x)},
                        {"y", std::to_string(faults.first->y)},
                        {"sample", std::to_string(faults.first->sample)}});
    return object({{"count", std::to_string(faults.invalid)}, {"first", first}});
}

/// How often a medium that varies was found denser than tracking had expected; a matter of noise, not of bias.
uint64_t majorants_exceeded(const Scene &scene) {
    const BoundedMedia *media = scene.medium ? scene.medium->bounded() : nullptr;
    return media ? media->exceeded() : 0;
}

} // namespace

std::string report_json(const ReportInput &in) {
    std::string adaptive = "null";
    if (in.samples_taken)
        adaptive = object(
            {{"fewest", std::to_string((*in.samples_taken)[0])}, {"most", std::to_string((*in.samples_taken)[1])}});
    std::vector<std::string> left_out = in.integrator.left_out();
    if (in.integrator.reconstructs())
        if (const char *reason = reason_against_reconstruction(in.scene, in.settings))
            left_out.push_back(std::string(reason) +
                               ": a sample counts for one pixel, not for all whose filter holds it");
    left_out.insert(left_out.end(), in.scene.left_out.begin(), in.scene.left_out.end());
    std::vector<std::string> warnings, warning_codes;
    for (const auto *source : {&in.settings.warnings, &in.scene.warnings})
        for (const Warning &w : *source) {
            warnings.push_back(w.text);
            warning_codes.emplace_back(kWarningNames[w.code]);
        }
    return object({
        {"engine", quoted(GLIMMER_VERSION)},
        {"integrator", quoted(kIntegrators[in.settings.integrator].name)},
        {"spp", std::to_string(in.progress.samples)},
        {"adaptive", adaptive},
        {"seed", std::to_string(in.settings.seed)},
        {"threads", std::to_string(in.settings.threads)},
        {"seconds", object({{"load", "0"},
                            {"build", number(in.scene.build_seconds)},
                            {"render", number(in.progress.seconds)},
                            {"cpu", number(in.progress.cpu_seconds)}})},
        {"rays", std::to_string(in.progress.rays)},
        {"peak_bytes", std::to_string(in.progress.peak_bytes)},
        {"majorants_exceeded", std::to_string(majorants_exceeded(in.scene))},
        {"invalid_samples", invalid_samples(in.faults)},
        {"error", error_with_tails(in.curve.error())},
        {"curve", curve_points(in.curve.points())},
        {"rate", fall_rate(in.curve.rate())},
        {"seconds_to_half", seconds_left(in.progress.seconds_to_half)},
        {"seconds_to_target", seconds_left(in.progress.seconds_to_target)},
        {"biased_by", list(biased_by(in.settings, in.faults))},
        {"kernel", quoted(in.integrator.kernel())},
        {"left_out", list(left_out)},
        {"warnings", list(warnings)},
        {"warning_codes", list(warning_codes)},
    });
}

} // namespace glimmer
