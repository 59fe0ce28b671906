// SPDX-License-Identifier: GPL-3.0-or-later
// The light vertices that matter to one block of pixels, resampled, and their bounded connections to points in the fog.
#pragma once

#include "integrator/light_paths.h"

namespace glimmer {

/// Resampled vertices. p_j is proportional to what vertex j brings to representative points of the block, one
/// systematic draw.
class VertexPool {
  public:
    VertexPool(const Scene &scene, const LightVertices &vertices, const PoolSettings &settings,
               const std::vector<Vec3f> &points, Sampler &sampler);

    bool empty() const { return fog_.size() == 0 && surface_.empty(); }

    /// The radiance that the fog at x scatters towards the camera, which looks along `seen`, per unit of its scattering
    /// weight, of all light that was scattered at least once before, each vertex by the share w(d), with the bounds of
    /// x (PoolSettings::widening): the sum over a sub-pool, less one vertex chosen by its part of the sum if that one
    /// is hidden, over its probability. Unbiased; single estimates may be negative.
    Rgb gather(const Vec3f &x, const Vec3f &seen, Sampler &sampler, RayCounter &rays) const;

  private:
    void pick_fog(const FogVertices &vertices, const std::vector<Vec3f> &points, Sampler &sampler);
    void pick_surface(const std::vector<SurfaceVertex> &vertices, const std::vector<Vec3f> &points, Sampler &sampler);

    const Scene &scene_;
    PoolSettings settings_;
    FogVertices fog_;                    ///< (sub_pools, fog_picks)
    std::vector<SurfaceVertex> surface_; ///< (sub_pools, surface_picks)
};

} // namespace glimmer
