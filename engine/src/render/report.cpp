// SPDX-License-Identifier: GPL-3.0-or-later
// The report of a render as JSON.
#include "render/session.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

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

} // namespace

std::string Session::report_json() {
    const glimmer_progress p = progress();
    // Of a large picture this takes a while: workers must not wait for it.
    std::string adaptive = "null";
    if (film_.adaptive()) {
        const auto [fewest, most] = film_.samples_taken();
        adaptive = "{\"fewest\": " + std::to_string(fewest) + ", \"most\": " + std::to_string(most) + "}";
    }
    const std::lock_guard lock(mutex_);
    constexpr auto no_limit = std::numeric_limits<uint32_t>::max();
    std::vector<std::string> biased;
    if (settings_.limits.depth != no_limit)
        biased.push_back("max_depth " + std::to_string(settings_.limits.depth));
    if (settings_.limits.scatter != no_limit)
        biased.push_back("max_scatter " + std::to_string(settings_.limits.scatter));
    if (invalid_count_)
        biased.push_back(std::to_string(invalid_count_) + " invalid samples counted as black");
    if (unfinished_count_)
        biased.push_back(std::to_string(unfinished_count_) + " samples broken off on paths without end");
    std::string curve;
    for (const CurvePoint &c : curve_)
        curve += (curve.empty() ? "[" : ", [") + number(c.seconds) + ", " + number(c.cpu_seconds) + ", " +
                 std::to_string(c.samples) + ", " + number(c.error.relmse) + ", " + number(c.error.low) + ", " +
                 number(c.error.high) + "]";
    std::string first = "null";
    if (!invalid_.empty())
        first = "{\"x\": " + std::to_string(invalid_[0].x) + ", \"y\": " + std::to_string(invalid_[0].y) +
                ", \"sample\": " + std::to_string(invalid_[0].sample) + "}";
    std::string tails = "null";
    if (error_.has_interval())
        tails = std::string("{\"certifiable\": ") + (error_.certifiable() ? "true" : "false") +
                ", \"largest_share\": " + number(error_.largest_share) +
                ", \"allowed\": " + number(kLargestShareAllowed) + ", \"x\": " + std::to_string(error_.x) +
                ", \"y\": " + std::to_string(error_.y) + "}";
    std::string error = "null";
    if (std::isfinite(error_.relmse))
        error = "{\"relmse\": " + number(error_.relmse) + ", \"low\": " + number(error_.low) +
                ", \"high\": " + number(error_.high) + ", \"confidence\": " + number(kErrorConfidence) +
                ", \"tails\": " + tails + "}";
    std::string rate = "null";
    if (std::isfinite(rate_.power))
        rate = "{\"power\": " + number(rate_.power) + ", \"low\": " + number(rate_.low) +
               ", \"high\": " + number(rate_.high) + ", \"confidence\": " + number(kErrorConfidence) + "}";
    const auto seconds_left = [](double seconds) { return seconds < 0 ? "null" : number(seconds); };
    std::string out = "{\"engine\": " + quoted(GLIMMER_VERSION);
    out += ", \"integrator\": " + quoted(kIntegrators[settings_.integrator].name);
    out += ", \"spp\": " + std::to_string(p.samples);
    out += ", \"adaptive\": " + adaptive;
    out += ", \"seed\": " + std::to_string(settings_.seed);
    out += ", \"threads\": " + std::to_string(settings_.threads);
    out += ", \"seconds\": {\"load\": 0, \"build\": " + number(scene_->build_seconds) +
           ", \"render\": " + number(p.seconds) + ", \"cpu\": " + number(p.cpu_seconds) + "}";
    out += ", \"rays\": " + std::to_string(p.rays);
    out += ", \"peak_bytes\": " + std::to_string(p.peak_bytes);
    out += ", \"invalid_samples\": {\"count\": " + std::to_string(invalid_count_) + ", \"first\": " + first + "}";
    out += ", \"error\": " + error;
    out += ", \"curve\": [" + curve + "]";
    out += ", \"rate\": " + rate;
    out += ", \"seconds_to_half\": " + seconds_left(p.seconds_to_half);
    out += ", \"seconds_to_target\": " + seconds_left(p.seconds_to_target);
    out += ", \"biased_by\": " + list(biased);
    out += ", \"kernel\": " + quoted(integrator_->kernel());
    std::vector<std::string> left_out = integrator_->left_out();
    left_out.insert(left_out.end(), scene_->left_out.begin(), scene_->left_out.end());
    out += ", \"left_out\": " + list(left_out);
    out += ", \"warnings\": " + list(scene_->warnings);
    return out + "}";
}

} // namespace glimmer
