// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "film/film.h"
#include "probe.h"

namespace glimmer::probe {

/// sums [height, width, 8, 3] of the replicates after `samples` samples.
inline void load_replicates(Film &film, const float *sums, uint64_t samples) {
    for (size_t t = 0; t < film.tiles().size(); ++t) {
        const Rectangle area = film.tiles()[t];
        Film::Tile tile(film, t);
        for (uint32_t y = 0; y < area.height; ++y)
            for (uint32_t x = 0; x < area.width; ++x)
                for (uint32_t r = 0; r < kReplicates; ++r) {
                    const size_t pixel = size_t(area.y + y) * film.width() + area.x + x;
                    FilmSample sample;
                    sample.emission = load_rgb(sums + (pixel * kReplicates + r) * 3);
                    tile.add(x, y, r, sample);
                }
        tile.commit(samples);
    }
}

} // namespace glimmer::probe
