// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/checkpoint.h"

#include "base/bytes.h"
#include "base/error.h"

namespace glimmer {

namespace {

constexpr uint64_t kMagic = 0x35304d494c47u; // "GLIM05"

/// Everything but the curve and the film, which follow. The checksum of all that comes after it stands first.
struct Head {
    uint64_t magic, seed, integrator, max_depth, max_scatter, adaptive;
    uint64_t rays, curve_size, invalid, unfinished, first_known, first_x, first_y, first_sample;
    double seconds, cpu_seconds;
};

/// A point of the curve, field by field: the file does not depend on how the engine lays its structs out.
struct SavedPoint {
    double seconds, cpu_seconds, relmse, low, high, largest_share, log_error;
    uint64_t samples, x, y;
    double without[kReplicates];
};

SavedPoint saved(const CurvePoint &p) {
    const ErrorEstimate &e = p.error;
    SavedPoint s{p.seconds,   p.cpu_seconds, e.relmse, e.low, e.high, e.largest_share,
                 e.log_error, p.samples,     e.x,      e.y,   {}};
    std::copy(e.without.begin(), e.without.end(), s.without);
    return s;
}

CurvePoint restored(const SavedPoint &s) {
    CurvePoint p{s.seconds, s.cpu_seconds, s.samples, {}};
    p.error.relmse = s.relmse;
    p.error.low = s.low;
    p.error.high = s.high;
    p.error.largest_share = s.largest_share;
    p.error.log_error = s.log_error;
    p.error.x = uint32_t(s.x);
    p.error.y = uint32_t(s.y);
    std::copy(std::begin(s.without), std::end(s.without), p.error.without.begin());
    return p;
}

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

void expect_same_settings(const Head &head, const RenderSettings &settings) {
    if (head.seed != settings.seed || head.integrator != settings.integrator)
        fail_argument("the saved state is of another seed or integrator");
    if (head.max_depth != settings.limits.depth || head.max_scatter != settings.limits.scatter)
        fail_argument("the saved state is of another max_depth or max_scatter");
    if (head.adaptive != uint64_t(settings.adaptive))
        fail_argument(std::string("the saved state is of a render ") + (head.adaptive ? "with" : "without") +
                      " adaptive sampling, and this one is " + (head.adaptive ? "without" : "with"));
}

} // namespace

std::vector<uint8_t> write_checkpoint(const RenderSettings &settings, const Progress &progress, const Film &film) {
    const SampleFaults &faults = progress.faults;
    Head head{};
    head.magic = kMagic;
    head.seed = settings.seed;
    head.integrator = settings.integrator;
    head.max_depth = settings.limits.depth;
    head.max_scatter = settings.limits.scatter;
    head.adaptive = settings.adaptive;
    head.rays = progress.rays;
    head.curve_size = progress.curve.size();
    head.invalid = faults.invalid;
    head.unfinished = faults.unfinished;
    head.first_known = faults.first ? 1 : 0;
    if (faults.first) {
        head.first_x = faults.first->x;
        head.first_y = faults.first->y;
        head.first_sample = faults.first->sample;
    }
    head.seconds = progress.seconds;
    head.cpu_seconds = progress.cpu_seconds;
    std::vector<uint8_t> out(sizeof(uint64_t));
    append(out, &head, 1);
    for (const CurvePoint &point : progress.curve) {
        const SavedPoint s = saved(point);
        append(out, &s, 1);
    }
    film.save(out);
    const uint64_t sum = checksum(out.data() + sizeof sum, out.size() - sizeof sum);
    std::memcpy(out.data(), &sum, sizeof sum);
    return out;
}

Progress read_checkpoint(const uint8_t *data, size_t size, const RenderSettings &settings, Film &film) {
    const uint8_t *at = data, *end = data + size;
    uint64_t sum;
    Head head;
    take(at, end, &sum, 1);
    const uint8_t *summed = at;
    take(at, end, &head, 1);
    if (head.magic != kMagic)
        fail_argument("this is not a saved state of a render, or one of another version");
    if (sum != checksum(summed, size_t(end - summed)))
        fail_argument("the saved state is damaged or ends too early");
    expect_same_settings(head, settings);
    if (head.curve_size > size_t(end - at) / sizeof(SavedPoint) || head.first_known > 1)
        fail_argument("the saved state is damaged");
    Progress progress;
    for (uint64_t i = 0; i < head.curve_size; ++i) {
        SavedPoint s;
        take(at, end, &s, 1);
        progress.curve.push_back(restored(s));
    }
    film.load(at, end); // refuses before it changes anything: from here on nothing fails
    progress.rays = head.rays;
    progress.seconds = head.seconds;
    progress.cpu_seconds = head.cpu_seconds;
    progress.faults.invalid = head.invalid;
    progress.faults.unfinished = head.unfinished;
    if (head.first_known)
        progress.faults.first = InvalidSample{uint32_t(head.first_x), uint32_t(head.first_y), head.first_sample};
    return progress;
}

} // namespace glimmer
