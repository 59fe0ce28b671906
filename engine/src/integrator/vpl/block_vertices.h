// SPDX-License-Identifier: GPL-3.0-or-later
// The light vertices that matter to one block of pixels, resampled, and their bounded connections to points in the
// medium.
#pragma once

#include "integrator/vpl/light_subpaths.h"

namespace glimmer {

/// Resampled vertices. p_j is proportional to what vertex j brings to representative points of the block, one
/// systematic draw.
class BlockVertices {
  public:
    BlockVertices(const Scene &scene, const LightVertices &vertices, const VplSettings &settings,
                  const std::vector<Vec3f> &points, Sampler &sampler);

    bool empty() const { return medium_.size() == 0 && surface_.empty(); }

    /// The radiance that the medium at x scatters towards the camera, which looks along `seen`, per unit of its
    /// scattering weight, of all light that was scattered at least once before, each vertex by the share w(d), with the
    /// bounds of x (VplSettings::widening): the sum over a sub-pool, less one vertex chosen by its part of the sum if
    /// that one is hidden, over its probability. Unbiased; single estimates may be negative.
    Rgb gather(const Vec3f &x, const Vec3f &seen, Sampler &sampler, TraceContext &rays) const;

  private:
    /// A vertex on a surface, shaded where it was picked, for all of its connections.
    struct ShadedVertex {
        SurfaceVertex vertex;
        Bsdf bsdf;
    };
    void pick_medium(const MediumVertices &vertices, const std::vector<Vec3f> &points, Sampler &sampler);
    void pick_surface(const std::vector<SurfaceVertex> &vertices, const std::vector<Vec3f> &points, Sampler &sampler);
    Bsdf shade(const SurfaceVertex &v);

    const Scene &scene_;
    VplSettings settings_;
    MediumVertices medium_;             ///< (subsets, medium_picks)
    std::vector<ShadedVertex> surface_; ///< (subsets, surface_picks)
    ClosureArena closures_;             ///< of surface_
};

} // namespace glimmer
