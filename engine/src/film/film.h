// SPDX-License-Identifier: GPL-3.0-or-later
// The film: running sums of the radiance, by replicate, and of every pass that was asked for.
//
// Samples come in waves. In wave w every pixel takes one sample, which belongs to replicate w mod kReplicates. Once an
// adaptive film has its allocation (film/sample_allocation.h), a pixel may take none or several samples in a wave.
// "Samples" of a tile or of the film are waves: the samples of each pixel without an allocation, and their mean over
// the picture with one.
#pragma once

#include "film/film_layout.h"
#include "film/passes.h"
#include "film/pixel_filter.h"
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
    /// passes: bit set of 1 << glimmer_pass. Each tile has a lock of its own. An adaptive film has no reach, as its
    /// pixels differ in their samples.
    Film(uint32_t width, uint32_t height, uint32_t tile_size, uint64_t passes, bool adaptive = false,
         const FilmReach &reach = {});

    uint32_t width() const { return width_; }
    uint32_t height() const { return height_; }
    uint64_t passes() const { return passes_; }
    size_t bytes() const;
    uint32_t reach() const { return layout_.reach(); }
    /// Those of the tiles with samples whose pixels are others since one tile was put back, itself first.
    std::vector<size_t> tiles_changed_by(size_t tile) const;

    const std::vector<Rectangle> &tiles() const { return layout_.tiles(); }
    uint64_t tile_samples(size_t tile) const { return tile_samples_[tile].load(std::memory_order_acquire); }
    uint64_t pixel_samples(uint32_t x, uint32_t y) const;
    /// The samples of the tile that has the fewest.
    uint64_t min_samples() const;

    using Cell = FilmLayout::Cell;
    const std::vector<Cell> &cells(size_t tile) const { return layout_.cells(tile); }

    /// One tile's sums, taken out, added to and put back, so that a reader only ever sees whole batches.
    class Tile;

    /// The running mean of a rectangle: (height, width, channels). Safe while tiles are being put back.
    void read(glimmer_pass pass, const Rectangle &where, float *pixels) const;

    /// Sums of the replicates of one pixel, as if each had taken one sample a wave. Not locked: for use between
    /// batches.
    Replicates replicates(uint32_t x, uint32_t y) const;

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
    /// Samples that replicate r of a pixel has taken after n waves, and those of all replicates.
    uint64_t taken(size_t pixel, uint32_t r, uint64_t n) const;
    uint64_t taken(size_t pixel, uint64_t n) const;
    /// The waves that a pixel's samples stand for after n waves: the divisor of all sums but the radiance's.
    float covered(size_t pixel, uint64_t n) const;
    SampleRange samples_of_wave(size_t pixel, uint64_t wave) const;
    /// Writes one pixel of a pass, by the rule of the pass.
    void read_pixel(glimmer_pass pass, uint32_t x, uint32_t y, float *out) const;
    /// The numbers with the largest parts of a pixel, largest first.
    void read_matte(const std::vector<float> &sums, uint32_t x, uint32_t y, float *pairs) const;

    uint32_t width_, height_, tile_size_;
    uint64_t passes_;
    FilmLayout layout_;
    std::unique_ptr<std::atomic<uint64_t>[]> tile_samples_;
    std::unique_ptr<std::mutex[]> tile_locks_;
    // By the slots of cells, those of a tile together:
    std::vector<Replicates> radiance_;
    std::array<std::vector<float>, GLIMMER_PASS_COUNT> sums_; ///< empty where a pass was not asked for
    std::vector<float> hits_;                 ///< waves that hit a surface; empty without the depth pass
    std::vector<PixelAllocation> allocation_; ///< empty unless adaptive
    bool allocated_ = false;
};

class Film::Tile {
  public:
    Tile(Film &film, size_t index);
    const Film &film() const { return film_; }
    /// The samples that a pixel takes in a wave.
    SampleRange samples_of_wave(int32_t x, int32_t y, uint64_t wave) const;
    /// Adds one of them, which was taken in a pixel of the cell.
    void add(const Cell &cell, int32_t x, int32_t y, uint64_t wave, const FilmSample &sample,
             const FilterWeights &weights = {});
    /// Adds light of a sample that counts otherwise, about any pixel.
    void add_light(const Cell &cell, int32_t x, int32_t y, uint64_t wave, const FilmSample &light,
                   const FilterWeights &weights);
    /// Puts the sums back and publishes that every pixel of the tile now has `samples`.
    void commit(uint64_t samples);

  private:
    void copy(bool put_back);
    /// function(slot of this tile, weight) for the pixels that a sample counts for.
    template <class Function>
    void for_pixels_around(const Cell &cell, int32_t x, int32_t y, const FilterWeights &weights,
                           const Function &function) const;
    /// Adds the parts of a pixel that a sample's surfaces take up to those of their numbers.
    static void add_covers(const PassSample &sample, uint32_t Cover::*number, float weight, float *pairs);
    void add_to_mean(glimmer_pass pass, size_t slot, const std::array<float, detail::kMaxPassChannels> &value,
                     float weight);

    Film &film_;
    size_t index_;
    size_t begin_, size_; ///< of its slots in the film
    std::vector<Replicates> radiance_;
    std::array<std::vector<float>, GLIMMER_PASS_COUNT> sums_;
    std::vector<float> hits_;
};

} // namespace glimmer
