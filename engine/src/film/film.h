// SPDX-License-Identifier: GPL-3.0-or-later
// Running sums of everything that was asked for. The radiance is kept in up to 8 independent replicates (sample s
// belongs to replicate s mod 8), from whose spread the standard errors come.
#pragma once

#include "film/passes.h"
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

/// Samples of replicate r among the first n.
constexpr uint64_t replicate_samples(uint64_t n, uint32_t r) {
    return (n + kReplicates - 1 - r) / kReplicates;
}

/// Mean of one pixel, and its standard error (a variance would leave the range of float long before the radiance does).
struct PixelEstimate {
    Rgb mean;
    Rgb standard_error; ///< of the mean; NaN below 2 samples
};

using Replicates = std::array<Rgb, kReplicates>;

class Film {
  public:
    /// passes: bit set of 1 << glimmer_pass. The picture is cut into tiles, each with a lock of its own. Only an
    /// adaptive film takes a plan; until then it is as any other. A pixel's "samples" are those of a film without a
    /// plan, one a pass; with one they are so in the mean over the picture alone.
    Film(uint32_t width, uint32_t height, uint32_t tile_size, uint32_t passes, bool adaptive = false);

    uint32_t width() const { return width_; }
    uint32_t height() const { return height_; }
    uint32_t passes() const { return passes_; }
    size_t bytes() const;

    const std::vector<Rectangle> &tiles() const { return tiles_; }
    uint64_t tile_samples(size_t tile) const { return tile_samples_[tile].load(std::memory_order_acquire); }
    uint64_t pixel_samples(uint32_t x, uint32_t y) const;
    /// Of the tile that has the fewest.
    uint64_t min_samples() const;

    /// One tile's sums, taken out, added to and put back, so that a reader only ever sees whole batches.
    class Tile;

    /// The running mean of a rectangle: (height, width, channels). Safe while tiles are being put back.
    void read(glimmer_pass pass, const Rectangle &where, float *pixels) const;

    /// Sums of the replicates of one pixel, as if each had taken one sample a pass; not locked, for use between
    /// batches.
    Replicates replicates(uint32_t x, uint32_t y) const {
        return at_one_a_pass(size_t(y) * width_ + x, pixel_samples(x, y));
    }

    bool adaptive() const { return !plan_.empty(); }
    bool planned() const { return planned_; }
    /// Of every pixel, row by row; all have kPlanPasses samples now. Between batches only.
    void set_plan(const std::vector<PixelPlan> &plan);
    /// The fewest and the most samples that a pixel has taken.
    std::array<uint64_t, 2> samples_taken() const;

    /// Raw state for checkpoints, appended to and taken from a byte stream; between batches only.
    void save(std::vector<uint8_t> &out) const;
    /// Throws Error when the state is of another film or does not end at `end`; the film is then as it was.
    void load(const uint8_t *&data, const uint8_t *end);

  private:
    friend class Tile;
    size_t tile_at(uint32_t x, uint32_t y) const;
    // Of pixel number `pixel` after n passes:
    uint64_t taken(size_t pixel, uint32_t r, uint64_t n) const;
    uint64_t taken(size_t pixel, uint64_t n) const; ///< by all replicates
    /// Passes that its samples stand for: what the sums of all passes but the radiance are divided by.
    float covered(size_t pixel, uint64_t n) const;
    Replicates at_one_a_pass(size_t pixel, uint64_t n) const;
    SampleRange samples_of_pass(size_t pixel, uint64_t pass) const;

    uint32_t width_, height_, tile_size_, tile_columns_, passes_;
    std::vector<Rectangle> tiles_; ///< in the order of rendering: from the centre outwards
    std::vector<uint32_t> tile_of_cell_;
    std::unique_ptr<std::atomic<uint64_t>[]> tile_samples_;
    std::unique_ptr<std::mutex[]> tile_locks_;
    std::vector<Replicates> radiance_;
    std::array<std::vector<float>, GLIMMER_PASS_COUNT> sums_; ///< empty where not asked for
    std::vector<float> hits_;                                 ///< passes with a depth
    std::vector<PixelPlan> plan_;                             ///< empty unless adaptive
    bool planned_ = false;
};

/// Mean and standard error of replicate sums after n samples. Var(mean) = sum_r n_r (m_r - m)^2 / ((R - 1) n), unbiased
/// when samples of one pixel are independent and their replicates hold n_r of them.
PixelEstimate estimate_pixel(const Replicates &sums, uint64_t n);

class Film::Tile {
  public:
    Tile(Film &film, size_t index);
    /// What the tile's pixel (x, y) takes of a pass: one sample, or what was planned.
    SampleRange samples_of_pass(uint32_t x, uint32_t y, uint64_t pass) const;
    /// Adds one of them.
    void add(uint32_t x, uint32_t y, uint64_t pass, const FilmSample &value);
    /// Puts the sums back and publishes that every pixel of the tile now has `samples`.
    void commit(uint64_t samples);

  private:
    void copy(bool put_back);

    Film &film_;
    size_t index_;
    Rectangle area_;
    std::vector<Replicates> radiance_;
    std::array<std::vector<float>, GLIMMER_PASS_COUNT> sums_;
    std::vector<float> hits_;
};

} // namespace glimmer
