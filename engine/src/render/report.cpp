// SPDX-License-Identifier: GPL-3.0-or-later
// The report of a render as JSON, and its state as bytes.
#include "api/error.h"
#include "film/bytes.h"
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

constexpr uint64_t kStateMagic = 0x31304d494c47u; // "GLIM01"

} // namespace

std::string Session::report_json() {
    const glimmer_progress p = progress();
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
    std::string error = "null";
    if (std::isfinite(error_.relmse))
        error = "{\"relmse\": " + number(error_.relmse) + ", \"low\": " + number(error_.low) +
                ", \"high\": " + number(error_.high) + ", \"confidence\": " + number(kErrorConfidence) + "}";
    std::string out = "{\"engine\": " + quoted(GLIMMER_VERSION);
    out += ", \"integrator\": " + quoted(kIntegrators[settings_.integrator].name);
    out += ", \"spp\": " + std::to_string(p.samples);
    out += ", \"seed\": " + std::to_string(settings_.seed);
    out += ", \"threads\": " + std::to_string(settings_.threads);
    out += ", \"seconds\": {\"load\": 0, \"build\": " + number(scene_->build_seconds) +
           ", \"render\": " + number(p.seconds) + ", \"cpu\": " + number(p.cpu_seconds) + "}";
    out += ", \"rays\": " + std::to_string(p.rays);
    out += ", \"peak_bytes\": " + std::to_string(p.peak_bytes);
    out += ", \"invalid_samples\": {\"count\": " + std::to_string(invalid_count_) + ", \"first\": " + first + "}";
    out += ", \"error\": " + error;
    out += ", \"curve\": [" + curve + "]";
    out += ", \"biased_by\": " + list(biased);
    out += ", \"kernel\": " + quoted(integrator_->kernel());
    out += ", \"left_out\": " + list(scene_->left_out);
    out += ", \"warnings\": " + list(scene_->warnings);
    return out + "}";
}

std::vector<uint8_t> Session::save() {
    std::unique_lock lock(mutex_);
    if (state_ == GLIMMER_RUNNING || busy_ || between_batches_)
        fail_state("a running render cannot be saved; pause it first");
    const uint64_t head[6] = {kStateMagic, settings_.seed, settings_.integrator,
                              rays_,       invalid_count_, uint64_t(curve_.size())};
    const double times[2] = {elapsed(), earlier_cpu_seconds_ + double(cpu_nanoseconds_) * 1e-9};
    std::vector<uint8_t> out;
    append(out, head, 6);
    append(out, times, 2);
    append(out, curve_.data(), curve_.size());
    film_.save(out);
    return out;
}

void Session::load(const uint8_t *data, size_t size) {
    const std::lock_guard lock(mutex_);
    if (state_ != GLIMMER_READY)
        fail_state("a saved state can only be loaded before the render starts");
    uint64_t head[6];
    double times[2];
    const uint8_t *at = data, *end = data + size;
    take(at, end, head, 6);
    take(at, end, times, 2);
    if (head[0] != kStateMagic)
        fail_argument("this is not a saved state of a render");
    if (head[1] != settings_.seed || head[2] != settings_.integrator)
        fail_argument("the saved state is of another seed or integrator");
    if (head[5] > 64) // one a doubling
        fail_argument("the saved state is damaged");
    std::vector<CurvePoint> curve(head[5], CurvePoint{});
    take(at, end, curve.data(), curve.size());
    film_.load(at, end);
    curve_ = std::move(curve);
    rays_ = head[3];
    invalid_count_ = head[4];
    earlier_seconds_ = times[0];
    earlier_cpu_seconds_ = times[1];
    if (!curve_.empty())
        error_ = curve_.back().error;
}

} // namespace glimmer
