// SPDX-License-Identifier: GPL-3.0-or-later
#include "film/film.h"
#include "probe.h"

using namespace glimmer;

/// sums [height, width, 8, 3] of the replicates when the plan is made. rates [height, width, 8]: samples a pass.
PROBE void probe_plan(const float *sums, uint32_t width, uint32_t height, float *rates) {
    Film film(width, height, 32, 0, true);
    for (size_t t = 0; t < film.tiles().size(); ++t) {
        const Rectangle area = film.tiles()[t];
        Film::Tile tile(film, t);
        for (uint32_t y = 0; y < area.height; ++y)
            for (uint32_t x = 0; x < area.width; ++x)
                for (uint32_t r = 0; r < kReplicates; ++r) {
                    FilmSample sample;
                    sample.emission =
                        probe::load_rgb(sums + ((size_t(area.y + y) * width + area.x + x) * kReplicates + r) * 3);
                    tile.add(x, y, r, sample);
                }
        tile.commit(kPlanPasses);
    }
    for (const PixelPlan &pixel : plan_samples(film, std::atomic<bool>(false)))
        for (const uint16_t rate : pixel.rates)
            *rates++ = float(rate) / float(PixelPlan::kUnit);
}
