// SPDX-License-Identifier: GPL-3.0-or-later
// Splats (docs/method.md, section 5): light that specular surfaces and the narrow lobes of metal throw into the medium,
// joined to the camera. No vertex holds that light, and a compensation ray would hit the narrow lobe only rarely.
#pragma once

#include "integrator/trace_context.h"
#include "integrator/vpl/vpl_settings.h"
#include "sampling/sampler.h"
#include "scene/scene.h"

#include <vector>

namespace glimmer {

/// Radiance that one light subpath adds to a pixel of the whole picture in its wave.
struct Splat {
    uint32_t x, y;
    Rgb radiance;
    uint8_t group; ///< LightFlags::group
};

/// The fraction that splats bring of the remainder that a surface sends along `light` (unit, of flight) to a point of
/// the medium, which the camera sees along `seen` (unit) where a part of the film is `footprint` wide
/// (Camera::footprint). Compensation rays bring the rest. The weight is bounding_weight of the footprint times the sine
/// between the two directions, for a perspective camera the distance h of the light's line from the camera: such a line
/// is bright as 1/h wherever it is seen, so that no weight in the point's distance alone would bound its splats.
inline float splat_fraction(float footprint, const Vec3f &seen, const Vec3f &light, const VplSettings &settings) {
    return bounding_weight(footprint * length(cross(seen, light)), settings.splat_clamp_distance);
}

/// A segment of a light subpath through the medium that began at a surface.
struct SubpathSegment {
    Ray ray; ///< t_max: where the segment ends
    Rgb power;
    float remainder; ///< fraction of the power that connections do not carry (bounded_fraction.h)
    uint8_t group;   ///< LightFlags::group
};

/// Whether a ray can lie in the picture at all, whatever stands in the way.
bool is_in_picture(const Scene &scene, const Ray &ray);

/// Joins points of the segment (Camera::sample_seen) with random points of the lens (Dutre, Lafortune, Willems 1993)
/// and appends the splats:
///     radiance = power remainder sigma_s T(segment) / pdf * phase * T(t) * splat_fraction / A * filter,
/// with A the area that a pixel sees there, t^2 d omega for a perspective camera, in every pixel whose filter holds the
/// image of the point.
void splat(const Scene &scene, const SubpathSegment &segment, const VplSettings &settings, Sampler &sampler,
           TraceContext &rays, std::vector<Splat> &out);

} // namespace glimmer
