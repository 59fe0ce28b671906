// SPDX-License-Identifier: GPL-3.0-or-later
// Renders waves of a tile.
#pragma once

#include "film/film.h"
#include "integrator/integrator.h"
#include "render/sample_faults.h"
#include "render/schedule.h"
#include "scene/scene.h"

#include <atomic>
#include <optional>
#include <span>

namespace glimmer {

class TileRenderer {
  public:
    /// stop: once set, tiles are broken off.
    TileRenderer(const Scene &scene, const Integrator &integrator, const Schedule &schedule, uint64_t seed,
                 const std::atomic<bool> &stop)
        : scene_(scene), integrator_(integrator), schedule_(schedule), seed_(seed), stop_(stop) {}

    /// Adds the waves from `first` to the end of the schedule's batch to a tile of the film. Nothing where it was
    /// broken off, at `deadline` (steady_seconds()) or by `stop`; the tile is then as it was.
    std::optional<SampleFaults> render(Film &film, size_t tile, uint64_t first, double deadline,
                                       TraceContext &trace) const;

  private:
    struct Work;
    struct WaveOffset;
    /// Nothing where each sample counts for one pixel and has a place of its own.
    std::optional<WaveOffset> offset_of_wave(const Film &film, uint64_t wave) const;
    /// Cells of one block.
    bool render_cells(Work &work, std::span<const Film::Cell> cells, uint64_t wave) const;
    bool render_pixel(Work &work, const Film::Cell &cell, int32_t x, int32_t y, uint64_t wave,
                      const std::optional<WaveOffset> &offset, std::unique_ptr<const BlockData> &shared) const;
    void add_parts(Work &work, const Film::Cell &cell, int32_t x, int32_t y, uint64_t wave, const SampleParts &parts,
                   const FilterWeights &weights) const;

    const Scene &scene_;
    const Integrator &integrator_;
    const Schedule &schedule_;
    uint64_t seed_;
    const std::atomic<bool> &stop_;
};

} // namespace glimmer
