// SPDX-License-Identifier: GPL-3.0-or-later
// Which work comes next. A render goes in batches of waves: first what the pixels of each wave share is prepared, then
// every tile takes all waves of the batch. At the end of a batch every pixel has the same number of samples, so that
// the picture can be judged there. Not locked.
#pragma once

#include "integrator/wave.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace glimmer {

class Schedule {
  public:
    /// shares: whether the pixels of a wave share anything. samples: where the render ends; 0: nowhere.
    Schedule(size_t tiles, bool shares, uint64_t samples) : tiles_(tiles), shares_(shares), samples_(samples) {}

    /// Begins the next batch of a film whose every pixel has `samples`; false where the render has what it wants.
    bool begin_batch(uint64_t samples);

    uint64_t first_wave() const { return first_; }
    uint64_t end_wave() const { return first_ + count_; }
    /// What the pixels of a wave of this batch share; null where they share nothing.
    const WaveData *shared(uint64_t wave) const { return waves_.empty() ? nullptr : waves_[wave - first_].get(); }

    /// A wave of this batch to prepare, if there is one left; a tile to render, once all waves are prepared.
    std::optional<uint64_t> take_wave();
    std::optional<size_t> take_tile();
    void put_wave(uint64_t wave, std::unique_ptr<const WaveData> data);
    /// seconds_a_wave: what the tile took, 0 where nothing was left to do. True when it was the last of the batch.
    bool put_tile(double seconds_a_wave);

    /// Waves that are done, with the part of the present batch; for progress.
    double waves_done() const;
    /// The most memory that the waves of one batch have taken.
    size_t peak_shared_bytes() const { return peak_shared_bytes_; }

  private:
    size_t tiles_;
    bool shares_;
    uint64_t samples_;

    uint64_t first_ = 0, count_ = 0; ///< waves of the batch
    std::vector<std::unique_ptr<const WaveData>> waves_;
    size_t next_wave_ = 0, done_waves_ = 0, next_tile_ = 0, done_tiles_ = 0;
    size_t shared_bytes_ = 0, peak_shared_bytes_ = 0;
    double slowest_tile_ = 0; ///< seconds a wave, in this batch: the next batch is planned by it
};

} // namespace glimmer
