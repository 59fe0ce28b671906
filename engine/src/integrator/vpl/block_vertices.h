// SPDX-License-Identifier: GPL-3.0-or-later
// The light vertices picked for one block of pixels, and VPL gathering (docs/method.md, sections 4, 5 and 7).
#pragma once

#include "integrator/trace_context.h"
#include "integrator/vpl/light_vertices.h"
#include "integrator/vpl/vpl_settings.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace glimmer {

/// Light vertices resampled for a block: vertex j is picked with a probability proportional to what it brings to a few
/// gather points of the block, all picks by one systematic draw, dealt out to interleaved subsets.
class BlockVertices {
  public:
    /// points: gather points that stand for the block. time: of the wave.
    BlockVertices(const Scene &scene, const LightVertices &vertices, const VplSettings &settings,
                  const std::vector<Vec3f> &points, ShutterTime time, Sampler &sampler);

    bool empty() const { return medium_.size() == 0 && surface_.empty(); }

    /// Radiance that the medium at x scatters towards the camera, which looks along `seen` (unit, away from the
    /// camera), per unit of the weight of scattering at x: all light that was scattered at least once before, each
    /// vertex weighted by w(d) with the clamp distance of x. The sum over one subset of the picks, corrected by one
    /// shadow ray. Unbiased over uniformly random subsets; a single estimate may be negative. room: how many vertices
    /// the depth limits leave to the light subpath; vertices of greater depth are not joined. groups: where not null,
    /// each part of the sum is added to the group of its light as well; the settings must be grouped.
    Rgb gather(const Vec3f &x, const Vec3f &seen, uint32_t subset, const DepthLimits &room, Sampler &sampler,
               TraceContext &rays, LightGroups *groups) const;

    uint32_t random_subset(Sampler &sampler) const {
        return std::min(uint32_t(sampler.next_1d() * float(settings_.subsets)), settings_.subsets - 1);
    }
    /// The subset of the k-th gather point of a segment whose first has `first`. Neighbours hold neighbouring picks, so
    /// a stride spreads what a segment sees over all of them.
    uint32_t subset_of(uint32_t first, uint32_t k) const {
        return (first + k * tuning::kSubsetStride) % settings_.subsets;
    }

  private:
    struct GatherQuery;
    struct Connections;
    /// What the sum takes for visible and is not.
    struct Hidden {
        Rgb value;
        uint8_t group = 0; ///< LightFlags::group of the chosen vertex
    };
    /// A picked surface vertex with its closures, which all of its connections share.
    struct ShadedVertex {
        SurfaceVertex vertex;
        Bsdf bsdf;
    };
    void pick_medium(const MediumVertices &vertices, const std::vector<Vec3f> &points, Sampler &sampler);
    void pick_surface(const std::vector<SurfaceVertex> &vertices, const std::vector<Vec3f> &points, Sampler &sampler);
    Bsdf shade(const SurfaceVertex &v);
    void connect_medium(const GatherQuery &point, const DepthLimits &room, Connections &connections) const;
    void connect_surface(const GatherQuery &point, const DepthLimits &room, Connections &connections) const;
    /// What a shadow ray to one vertex, chosen by its part of the sum, shows to be hidden.
    Hidden estimate_hidden(const GatherQuery &point, const Connections &connections, float left,
                           TraceContext &rays) const;
    /// estimate_hidden() where the chosen vertex is in the medium.
    Hidden estimate_hidden_medium(const GatherQuery &point, const Connections &connections, float left,
                                  TraceContext &rays) const;
    /// What is hidden of a chosen vertex that brings `value` along `ray`, over the probability of the choice: `part` of
    /// the sum.
    Rgb hidden(const Connections &connections, const Rgb &value, float part, const Ray &ray, TraceContext &rays) const;
    void add_by_group(const GatherQuery &point, const Connections &connections, const Hidden &hidden,
                      LightGroups &groups) const;

    const Scene &scene_;
    VplSettings settings_;
    ShutterTime time_;
    VertexDepth deepest_;               ///< greatest depths of the picks in the medium; 0 where depths are not kept
    MediumVertices medium_;             ///< (subsets, kMediumPicks)
    std::vector<ShadedVertex> surface_; ///< (subsets, kSurfacePicks)
    ClosureArena closures_;             ///< those that surface_ refers to
};

} // namespace glimmer
