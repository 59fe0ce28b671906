// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/schedule.h"

#include <algorithm>

namespace glimmer {

namespace {

/// Waves of a batch at most. What waves share is kept for the whole batch, so there are fewer of those. Chosen.
constexpr uint64_t kLargestBatch = 64, kLargestSharedBatch = 16;
/// Cancelling and the display wait for the tile that is being rendered, so a batch takes no longer for it. Chosen.
constexpr double kTileSeconds = 0.25;

} // namespace

/// As many waves as there were so far, so that the picture can be judged at every doubling; fewer where a tile would
/// take too long.
bool Schedule::begin_batch(uint64_t samples) {
    if (samples_ && samples >= samples_)
        return false;
    uint64_t doubling = 1;
    while (doubling <= samples)
        doubling *= 2;
    count_ = std::min(doubling - samples, shares_ ? kLargestSharedBatch : kLargestBatch);
    if (slowest_tile_ > 0)
        count_ = std::min(count_, std::max<uint64_t>(uint64_t(kTileSeconds / slowest_tile_), 1));
    if (samples_)
        count_ = std::min(count_, samples_ - samples);
    first_ = samples;
    waves_.clear();
    waves_.resize(shares_ ? count_ : 0);
    next_wave_ = done_waves_ = next_tile_ = done_tiles_ = 0;
    shared_bytes_ = 0;
    slowest_tile_ = 0;
    return true;
}

std::optional<uint64_t> Schedule::take_wave() {
    if (next_wave_ == waves_.size())
        return std::nullopt;
    return first_ + next_wave_++;
}

std::optional<size_t> Schedule::take_tile() {
    if (done_waves_ < waves_.size() || next_tile_ == tiles_)
        return std::nullopt;
    return next_tile_++;
}

void Schedule::put_wave(uint64_t wave, std::unique_ptr<const WaveData> data) {
    shared_bytes_ += data->bytes();
    peak_shared_bytes_ = std::max(peak_shared_bytes_, shared_bytes_);
    waves_[wave - first_] = std::move(data);
    ++done_waves_;
}

bool Schedule::put_tile(double seconds_a_wave) {
    slowest_tile_ = std::max(slowest_tile_, seconds_a_wave);
    return ++done_tiles_ == tiles_;
}

double Schedule::waves_done() const {
    return double(first_) + double(count_) * double(done_tiles_) / double(tiles_);
}

} // namespace glimmer
