// SPDX-License-Identifier: GPL-3.0-or-later
// Lengths and counts of the shared light vertices, derived from the scene (see LightVertexCache).
#pragma once

#include "math/vec.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace glimmer {

struct VplSettings {
    uint32_t paths = 0;   ///< light paths a pass
    uint32_t gathers = 4; ///< (see LightVertexCache) medium points on a segment that the camera sees directly
    uint32_t subsets = 8; ///< each gather takes one of them, so that neighbours differ
    /// In a sub-pool; medium_picks a multiple of 16 (simd/loops.h).
    static constexpr uint32_t medium_picks = 128, surface_picks = 8;
    float medium_clamp_distance = 1,
          surface_clamp_distance = 2; ///< d0, lengths: a connection counts w(d) = d^2 / (d^2 + d0^2) of itself
    float splat_clamp_distance = 1;   ///< the same for splats, by the beam's distance from the camera (see splat_share)
    float median_distance = kInfinity; ///< from the camera: half of what it sees of the medium is nearer
    float effective_attenuation = 0;   ///< diffusion() of the medium, per length

    /// What the bounds of a gather are to be multiplied by: g(r) = e^(decay (r - r_0)) r / r_0 >= 1, at the distance r
    /// from the camera beyond r_0 = 2 median_distance. That far off, the weight window leaves few and heavy vertices:
    /// their weight goes with importance^(-3/4), importance with e^(-decay r) / r (ImportanceMap), and the few that
    /// paths raised by roulette meet there were spikes in one picture of twenty. d0 ~ density^(-1/2), as in
    /// LightVertexCache::set_bounds, with the window's density alone would be g to the power of 3/8. But the light
    /// thins out as well, and roulette raises what gathers there: measured, 3/8 leaves most of the spikes, 1 next to
    /// none, and powers of r alone lose elsewhere; from 1.5 median_distance on, thin medium full of lights loses. As it
    /// depends on nothing but the point, nothing is biased while the ray that brings what its connections leave out
    /// takes the same.
    float clamp_distance_scale(float r) const {
        constexpr float kFar = 2;
        constexpr float kMost = 1e6f; // finite, and far beyond where connections still bring anything
        const float r0 = kFar * median_distance;
        return r > r0 ? std::min(std::exp(effective_attenuation * (r - r0)) * (r / r0), kMost) : 1;
    }
};

/// w(d), the share of a bounded connection.
inline float bounding_weight(float d, float bound) {
    const float d2 = d * d;
    return d2 > 0 ? d2 / (d2 + bound * bound) : 0;
}

} // namespace glimmer
