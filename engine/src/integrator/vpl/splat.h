// SPDX-License-Identifier: GPL-3.0-or-later
// Light paths that the camera sees: what mirrors, glass and the narrow lobes of metal throw into the medium in front of
// it. No vertex holds that light (bounded_fraction.h), and a ray from the medium would hit a lobe's light only now and
// then.
#pragma once

#include "integrator/integrator.h"
#include "integrator/vpl/vpl_settings.h"

#include <vector>

namespace glimmer {

/// Radiance that one light path adds to a pixel of the whole picture in its pass.
struct Splat {
    uint32_t x, y;
    Rgb radiance;
};

/// The share of what arrives at a medium point along `light` from an unheld surface that splats bring, when the camera
/// sees the point directly, along `seen`, where a part of the film is `footprint` wide (Camera::footprint); rays from
/// the gathers bring the rest. A beam that passes a perspective camera at the distance h is bright as 1/h wherever it
/// is seen: no bound on the point's distance alone would bound its splats.
inline float splat_share(float footprint, const Vec3f &seen, const Vec3f &light, const VplSettings &settings) {
    return bounding_weight(footprint * length(cross(seen, light)), settings.splat_clamp_distance);
}

/// A segment of a light path through the medium that began at an unheld surface.
struct SubpathSegment {
    Ray ray; ///< t_max: its end
    Rgb power;
    float remainder; ///< the share of the power that no vertex holds
};

/// Whether any of it can be in the picture, whatever stands in the way.
bool is_seen(const Scene &scene, const Ray &beam);

/// Joins points of the beam (Camera::sample_seen) with random points of the lens (Dutre, Lafortune, Willems 1993):
/// radiance = power sigma_s T / pdf / (4 pi) T / A times the filter, in every pixel whose filter holds the point's
/// image, where A is the area that the pixel sees there, t^2 d omega for a perspective camera.
void splat(const Scene &scene, const SubpathSegment &beam, const VplSettings &settings, Sampler &sampler,
           TraceContext &rays, std::vector<Splat> &out);

} // namespace glimmer
