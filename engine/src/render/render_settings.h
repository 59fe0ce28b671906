// SPDX-License-Identifier: GPL-3.0-or-later
// What a caller asks of a render.
#pragma once

#include "base/warning.h"
#include "integrator/depth_limits.h"

#include <cstdint>
#include <vector>

namespace glimmer {

struct RenderSettings {
    uint32_t integrator = 0; ///< of kIntegrators
    uint64_t samples = 0;    ///< a pixel; 0: no limit
    double seconds = 0;      ///< of wall time; 0: no limit
    double target_error = 0; ///< relMSE; 0: no limit
    uint64_t seed = 0;
    uint32_t threads = 0;    ///< 0: one for each core
    uint32_t tile_size = 64; ///< pixels
    uint64_t passes = 1;     ///< bit set of 1 << glimmer_pass
    DepthLimits limits;
    bool adaptive = false;           ///< film/sample_allocation.h
    bool independent_pixels = false; ///< each sample counts for one: render/reconstruction.h
    bool full_kernel = false;        ///< make_integrator
    std::vector<Warning> warnings;   ///< of the settings themselves, for the report
};

} // namespace glimmer
