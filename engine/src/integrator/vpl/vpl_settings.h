// SPDX-License-Identifier: GPL-3.0-or-later
// Counts and lengths of the light vertex cache, set once for a scene (docs/method.md, section 8).
#pragma once

#include "integrator/depth_limits.h"
#include "integrator/vpl/tuning.h"
#include "math/vec.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace glimmer {

class InteriorStack;
class Scene;

struct VplSettings {
    DepthLimits limits;                  ///< of a whole path, from the camera to the light
    bool grouped = false;                ///< vertices and splats know the group of their light
    uint32_t paths = 0;                  ///< light subpaths a wave
    uint32_t gathers = tuning::kGathers; ///< gather points on a segment that the camera sees directly
    uint32_t subsets = tuning::kSubsets; ///< interleaved subsets of a block's picks; each gather point takes one
    float medium_clamp_distance = 1;     ///< d0 of connections to medium vertices, a length
    float surface_clamp_distance = 2;    ///< d0 of connections to surface vertices
    float splat_clamp_distance = 1;      ///< d0 of splats, by the footprint of the segment's line (see splat_fraction)
    float median_distance = kInfinity;   ///< half of what the camera sees of the medium is nearer than this
    float effective_attenuation = 0;     ///< kappa of the medium, per length

    /// Factor on the clamp distances of a gather point at the distance r from the camera (Camera::distance):
    /// max(1, e^(kappa (r - r0)) r / r0), with r0 = kFarMedians median distances. Beyond r0 the weight window leaves
    /// few and heavy vertices, whose unbounded connections are spikes. The density of vertices alone would ask for this
    /// to the power of 3/8 (docs/method.md, section 8); roulette on the camera's side makes 1 the better power. Nothing
    /// is biased, since the factor depends on the point alone and the compensation ray of the point takes the same.
    float clamp_distance_scale(float r) const {
        const float r0 = tuning::kFarMedians * median_distance;
        return r > r0 ? std::min(std::exp(effective_attenuation * (r - r0)) * (r / r0), tuning::kMostClampScale) : 1;
    }
};

/// w(d) = d^2 / (d^2 + d0^2): with it, the geometry term 1/d^2 of a connection becomes 1/(d^2 + d0^2).
inline float bounding_weight(float d, float d0) {
    const float d2 = d * d;
    return d2 > 0 ? d2 / (d2 + d0 * d0) : 0;
}

/// Sets everything from the size of the picture and from a pilot of light subpaths. The scene has a medium that
/// scatters.
VplSettings make_vpl_settings(const Scene &scene, const DepthLimits &limits, const InteriorStack &around_camera);

} // namespace glimmer
