// SPDX-License-Identifier: GPL-3.0-or-later
// The state of a render as bytes, and back. What is not the very bytes that were saved is refused as a whole.
#pragma once

#include "film/film.h"
#include "render/rate.h"
#include "render/render_settings.h"
#include "render/sample_faults.h"

#include <cstdint>
#include <vector>

namespace glimmer {

/// All that a render knows but its film.
struct Progress {
    uint64_t rays = 0;
    double seconds = 0, cpu_seconds = 0;
    SampleFaults faults;
    std::vector<CurvePoint> curve;
};

std::vector<uint8_t> write_checkpoint(const RenderSettings &settings, const Progress &progress, const Film &film);

/// Throws Error, with the film as it was, where the bytes are damaged or of a render with other settings.
Progress read_checkpoint(const uint8_t *data, size_t size, const RenderSettings &settings, Film &film);

} // namespace glimmer
