// SPDX-License-Identifier: GPL-3.0-or-later
// The light vertex cache (docs/method.md, section 3): light vertices that all pixels of a wave share, and the picks of
// them for one block of pixels.
#pragma once

#include "integrator/depth_limits.h"
#include "integrator/vpl/block_vertices.h"
#include "integrator/wave.h"
#include "math/rectangle.h"
#include "medium/interior_stack.h"

#include <memory>
#include <string>

namespace glimmer {

/// What the pixels of one block share in one wave.
struct LightVertexBlock final : BlockData {
    LightVertexBlock(const VplSettings &settings_, BlockVertices &&vertices_, const Rectangle &pixels_)
        : settings(settings_), vertices(std::move(vertices_)), pixels(pixels_),
          splats(size_t(pixels.width) * pixels.height), splat_groups(settings.grouped ? splats.size() : 0) {}
    size_t index(uint32_t x, uint32_t y) const { return size_t(y - pixels.y) * pixels.width + (x - pixels.x); }
    void add(const Splat &splat) {
        const size_t i = index(splat.x, splat.y);
        splats[i] += splat.radiance;
        if (settings.grouped && splat.group)
            splat_groups[i][splat.group - 1u] += splat.radiance;
    }
    VplSettings settings;
    BlockVertices vertices;
    Rectangle pixels;
    std::vector<Rgb> splats;               ///< radiance that the splats of the wave add, (height, width)
    std::vector<LightGroups> splat_groups; ///< the same by group; empty unless grouped
    bool unfinished = false;               ///< a light subpath of the wave was broken off
};

class LightVertexCache {
  public:
    LightVertexCache(const Scene &scene, const DepthLimits &limits, const InteriorStack &around_camera, bool grouped);

    /// Traces the light subpaths of a wave.
    std::unique_ptr<const WaveData> prepare_wave(uint64_t seed, uint64_t sample, TraceContext &rays) const;
    /// Picks vertices for a block and collects its splats.
    std::unique_ptr<const BlockData> prepare_block(const WaveData &wave, const Rectangle &block,
                                                   TraceContext &rays) const;

  private:
    const Scene &scene_;
    InteriorStack around_camera_;
    VplSettings settings_;
};

struct LightVertexPlan {
    std::unique_ptr<const LightVertexCache> cache; ///< null where plain path tracing takes over
    std::string left_out; ///< why there is no cache, a line for the report; empty where no medium scatters
};

/// The cache for a scene. grouped: passes show light by its group. docs/method.md, section 9, lists where there is
/// none.
LightVertexPlan plan_light_vertex_cache(const Scene &scene, const DepthLimits &limits,
                                        const InteriorStack &around_camera, bool grouped);

} // namespace glimmer
