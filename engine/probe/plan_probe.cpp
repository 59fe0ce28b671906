// SPDX-License-Identifier: GPL-3.0-or-later
#include "film_probe.h"

using namespace glimmer;

/// sums [height, width, 8, 3] of the replicates when the plan is made. rates [height, width, 8]: samples a pass.
PROBE void probe_plan(const float *sums, uint32_t width, uint32_t height, float *rates) {
    Film film(width, height, 32, 0, true);
    probe::load_replicates(film, sums, kPlanPasses);
    for (const PixelPlan &pixel : plan_samples(film, std::atomic<bool>(false)))
        for (const uint16_t rate : pixel.rates)
            *rates++ = float(rate) / float(PixelPlan::kUnit);
}
