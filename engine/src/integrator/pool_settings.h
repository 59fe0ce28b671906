// SPDX-License-Identifier: GPL-3.0-or-later
// Lengths and counts of the shared light vertices, derived from the scene (see LightPool).
#pragma once

#include <cstdint>

namespace glimmer {

struct PoolSettings {
    uint32_t paths = 0;     ///< light paths a pass
    uint32_t gathers = 4;   ///< fog points on a segment that the camera sees directly
    uint32_t sub_pools = 8; ///< each gather takes one of them, so that neighbours differ
    /// In a sub-pool; fog_picks a multiple of 16 (simd/loops.h).
    static constexpr uint32_t fog_picks = 128, surface_picks = 8;
    float fog_bound = 1, surface_bound = 2; ///< d0, lengths: a connection counts w(d) = d^2 / (d^2 + d0^2) of itself
    float splat_bound = 1;                  ///< the same for splats, by the beam's distance from the camera
};

/// w(d), the share of a bounded connection.
inline float connected_share(float d, float bound) {
    const float d2 = d * d;
    return d2 > 0 ? d2 / (d2 + bound * bound) : 0;
}

} // namespace glimmer
