// SPDX-License-Identifier: GPL-3.0-or-later
#include "film_probe.h"

using namespace glimmer;

/// sums [height, width, 8, 3] of the replicates when samples are allocated. rates [height, width, 8]: samples a wave.
PROBE void probe_allocation(const float *sums, uint32_t width, uint32_t height, float *rates) {
    Film film(width, height, 32, 0, true);
    probe::load_replicates(film, sums, kUniformWaves);
    for (const PixelAllocation &pixel : allocate_samples(film, std::atomic<bool>(false)))
        for (const uint16_t rate : pixel.rates)
            *rates++ = float(rate) / float(PixelAllocation::kUnit);
}
