// SPDX-License-Identifier: GPL-3.0-or-later
// The state of a render as bytes, and back. What is not the very bytes that were saved is refused as a whole.
#include "base/bytes.h"
#include "base/error.h"
#include "render/session.h"

namespace glimmer {

namespace {

constexpr uint64_t kStateMagic = 0x33304d494c47u; // "GLIM03"

/// Everything but the curve and the film, which follow; the checksum of all that comes after it stands first.
struct StateHead {
    uint64_t magic, seed, integrator, max_depth, max_scatter, adaptive;
    uint64_t rays, curve_size, invalid_count, unfinished_count, first_invalid_known;
    InvalidSample first_invalid;
    double seconds, cpu_seconds;
};

/// FNV-1a over words of 8 bytes, the last one filled up with zeros: finds any damage of a single word, and of more but
/// for one in 2^64.
uint64_t checksum(const uint8_t *data, size_t size) {
    uint64_t hash = 14695981039346656037u ^ size;
    for (size_t i = 0; i < size; i += 8) {
        uint64_t word = 0;
        std::memcpy(&word, data + i, std::min<size_t>(8, size - i));
        hash = (hash ^ word) * 1099511628211u;
    }
    return hash;
}

} // namespace

std::vector<uint8_t> Session::save() {
    std::unique_lock lock(mutex_);
    if (state_ == GLIMMER_RUNNING || busy_ || between_batches_)
        fail_state("a running render cannot be saved; pause it first");
    StateHead head{};
    head.magic = kStateMagic;
    head.seed = settings_.seed;
    head.integrator = settings_.integrator;
    head.max_depth = settings_.limits.depth;
    head.max_scatter = settings_.limits.scatter;
    head.adaptive = settings_.adaptive;
    head.rays = rays_;
    head.curve_size = curve_.size();
    head.invalid_count = invalid_count_;
    head.unfinished_count = unfinished_count_;
    head.first_invalid_known = invalid_.size();
    if (!invalid_.empty())
        head.first_invalid = invalid_.front();
    head.seconds = elapsed();
    head.cpu_seconds = earlier_cpu_seconds_ + double(cpu_nanoseconds_) * 1e-9;
    std::vector<uint8_t> out(sizeof(uint64_t));
    append(out, &head, 1);
    append(out, curve_.data(), curve_.size());
    film_.save(out);
    const uint64_t sum = checksum(out.data() + sizeof sum, out.size() - sizeof sum);
    std::memcpy(out.data(), &sum, sizeof sum);
    return out;
}

void Session::load(const uint8_t *data, size_t size) {
    const std::lock_guard lock(mutex_);
    if (state_ != GLIMMER_READY)
        fail_state("a saved state can only be loaded before the render starts");
    const uint8_t *at = data, *end = data + size;
    uint64_t sum;
    StateHead head;
    take(at, end, &sum, 1);
    const uint8_t *summed = at;
    take(at, end, &head, 1);
    if (head.magic != kStateMagic)
        fail_argument("this is not a saved state of a render, or one of another version");
    if (sum != checksum(summed, size_t(end - summed)))
        fail_argument("the saved state is damaged or ends too early");
    if (head.seed != settings_.seed || head.integrator != settings_.integrator)
        fail_argument("the saved state is of another seed or integrator");
    if (head.max_depth != settings_.limits.depth || head.max_scatter != settings_.limits.scatter)
        fail_argument("the saved state is of another max_depth or max_scatter");
    if (head.adaptive != uint64_t(settings_.adaptive))
        fail_argument(std::string("the saved state is of a render ") + (head.adaptive ? "with" : "without") +
                      " adaptive sampling, and this one is " + (head.adaptive ? "without" : "with"));
    if (head.curve_size > size_t(end - at) / sizeof(CurvePoint) || head.first_invalid_known > 1)
        fail_argument("the saved state is damaged");
    std::vector<CurvePoint> curve(head.curve_size, CurvePoint{});
    take(at, end, curve.data(), curve.size());
    film_.load(at, end); // refuses before it changes anything: from here on nothing fails
    curve_ = std::move(curve);
    rays_ = head.rays;
    invalid_count_ = head.invalid_count;
    unfinished_count_ = head.unfinished_count;
    invalid_.assign(head.first_invalid_known, head.first_invalid);
    earlier_seconds_ = head.seconds;
    earlier_cpu_seconds_ = head.cpu_seconds;
    judge_curve();
    dirty_order_.clear();
    for (size_t i = 0; i < film_.tiles().size(); ++i) {
        dirty_[i] = film_.tile_samples(i) > 0;
        if (dirty_[i])
            dirty_order_.push_back(i);
    }
    ++version_;
}

} // namespace glimmer
