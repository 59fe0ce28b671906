// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "film/film.h"
#include "probe.h"

namespace glimmer::probe {

/// sums [height, width, 8, 3] of the replicates after `samples` samples.
inline void load_replicates(Film &film, const float *sums, uint64_t samples) {
    for (size_t t = 0; t < film.tiles().size(); ++t) {
        Film::Tile tile(film, t);
        for (const Film::Cell &cell : film.cells(t))
            for (int32_t y = cell.sampled.y0; y < cell.sampled.y1; ++y)
                for (int32_t x = cell.sampled.x0; x < cell.sampled.x1; ++x)
                    for (uint32_t r = 0; r < kReplicates; ++r) {
                        const size_t pixel = size_t(y) * film.width() + size_t(x);
                        FilmSample sample;
                        sample.emission = load_rgb(sums + (pixel * kReplicates + r) * 3);
                        tile.add(cell, x, y, r, sample);
                    }
        tile.commit(samples);
    }
}

} // namespace glimmer::probe
