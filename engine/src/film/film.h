// SPDX-License-Identifier: GPL-3.0-or-later
// The film: running sums of the radiance, by replicate, and of every pass that was asked for.
//
// Samples come in waves. In wave w every pixel takes one sample, which belongs to replicate w mod kReplicates. Once an
// adaptive film has its allocation (film/sample_allocation.h), a pixel may take none or several samples in a wave.
// "Samples" of a tile or of the film are waves: the samples of each pixel without an allocation, and their mean over
// the picture with one.
#pragma once

#include "film/passes.h"
#include "film/replicates.h"
#include "film/sample.h"
#include "film/sample_allocation.h"
#include "math/rectangle.h"

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

namespace glimmer {

class Film {
  public:
    /// passes: bit set of 1 << glimmer_pass. The picture is cut into tiles, each with a lock of its own.
    Film(uint32_t width, uint32_t height, uint32_t tile_size, uint64_t passes, bool adaptive = false);

    uint32_t width() const { return width_; }
    uint32_t height() const { return height_; }
    uint64_t passes() const { return passes_; }
    size_t bytes() const;

    const std::vector<Rectangle> &tiles() const { return tiles_; }
    uint64_t tile_samples(size_t tile) const { return tile_samples_[tile].load(std::memory_order_acquire); }
    uint64_t pixel_samples(uint32_t x, uint32_t y) const;
    /// The samples of the tile that has the fewest.
    uint64_t min_samples() const;

    /// One tile's sums, taken out, added to and put back, so that a reader only ever sees whole batches.
    class Tile;

    /// The running mean of a rectangle: (height, width, channels). Safe while tiles are being put back.
    void read(glimmer_pass pass, const Rectangle &where, float *pixels) const;

    /// Sums of the replicates of one pixel, as if each had taken one sample a wave. Not locked: for use between
    /// batches.
    Replicates replicates(uint32_t x, uint32_t y) const {
        return at_one_a_wave(size_t(y) * width_ + x, pixel_samples(x, y));
    }

    bool adaptive() const { return !allocation_.empty(); }
    bool allocated() const { return allocated_; }
    /// Sets the allocation of every pixel, row by row, when all have taken kUniformWaves samples. Between batches only.
    void set_allocation(const std::vector<PixelAllocation> &allocation);
    /// The fewest and the most samples that a pixel has taken.
    std::array<uint64_t, 2> samples_taken() const;

    /// Raw state for checkpoints, appended to and taken from a byte stream. Between batches only.
    void save(std::vector<uint8_t> &out) const;
    /// Throws Error when the state is of another film or does not end at `end`; the film is then as it was.
    void load(const uint8_t *&data, const uint8_t *end);

  private:
    friend class Tile;
    size_t tile_at(uint32_t x, uint32_t y) const;
    /// Samples that replicate r of a pixel has taken after n waves, and those of all replicates.
    uint64_t taken(size_t pixel, uint32_t r, uint64_t n) const;
    uint64_t taken(size_t pixel, uint64_t n) const;
    /// The waves that a pixel's samples stand for after n waves: the divisor of all sums but the radiance's.
    float covered(size_t pixel, uint64_t n) const;
    Replicates at_one_a_wave(size_t pixel, uint64_t n) const;
    SampleRange samples_of_wave(size_t pixel, uint64_t wave) const;
    /// Writes one pixel of a pass after n waves, by the rule of the pass.
    void read_pixel(glimmer_pass pass, size_t pixel, uint64_t n, float *out) const;

    uint32_t width_, height_, tile_size_, tile_columns_;
    uint64_t passes_;
    std::vector<Rectangle> tiles_; ///< in the order of rendering: from the centre outwards
    std::vector<uint32_t> tile_of_cell_;
    std::unique_ptr<std::atomic<uint64_t>[]> tile_samples_;
    std::unique_ptr<std::mutex[]> tile_locks_;
    std::vector<Replicates> radiance_;
    std::array<std::vector<float>, GLIMMER_PASS_COUNT> sums_; ///< empty where a pass was not asked for
    std::vector<float> hits_;                 ///< waves that hit a surface; empty without the depth pass
    std::vector<PixelAllocation> allocation_; ///< empty unless adaptive
    bool allocated_ = false;
};

class Film::Tile {
  public:
    Tile(Film &film, size_t index);
    /// The samples that the tile's pixel (x, y) takes in a wave.
    SampleRange samples_of_wave(uint32_t x, uint32_t y, uint64_t wave) const;
    /// Adds one of them.
    void add(uint32_t x, uint32_t y, uint64_t wave, const FilmSample &sample);
    /// Puts the sums back and publishes that every pixel of the tile now has `samples`.
    void commit(uint64_t samples);

  private:
    void copy(bool put_back);
    /// Adds the parts of a pixel that a sample's surfaces take up to those of their numbers.
    static void add_covers(const PassSample &sample, uint32_t Cover::*number, float weight, float *pairs);
    void add_to_pass(glimmer_pass pass, size_t pixel, uint64_t wave, const FilmSample &sample, float weight);

    Film &film_;
    size_t index_;
    Rectangle area_;
    std::vector<Replicates> radiance_;
    std::array<std::vector<float>, GLIMMER_PASS_COUNT> sums_;
    std::vector<float> hits_;
};

} // namespace glimmer
