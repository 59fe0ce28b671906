// SPDX-License-Identifier: GPL-3.0-or-later
// Light vertices shared by all pixels of a pass: when they serve, how many there are, and who prepares them.
#pragma once

#include "integrator/vpl/block_vertices.h"

namespace glimmer {

struct LightVertexBlock final : BlockData {
    LightVertexBlock(const VplSettings &settings_, BlockVertices &&pool_, const Rectangle &pixels_)
        : settings(settings_), pool(std::move(pool_)), pixels(pixels_), splats(size_t(pixels.width) * pixels.height) {}
    /// What the splats of the pass add to a pixel of the block.
    const Rgb &splatted(uint32_t x, uint32_t y) const {
        return splats[size_t(y - pixels.y) * pixels.width + (x - pixels.x)];
    }
    VplSettings settings;
    BlockVertices pool;
    Rectangle pixels;
    std::vector<Rgb> splats; ///< (height, width)
    bool unfinished = false; ///< a light path of the pass was broken off
};

class LightVertexCache {
  public:
    LightVertexCache(const Scene &scene, const InteriorStack &around_camera);

    std::unique_ptr<const WaveData> prepare_wave(uint64_t seed, uint64_t sample, const std::atomic<bool> &stop,
                                                 TraceContext &rays) const;
    std::unique_ptr<const BlockData> prepare_block(const WaveData &pass, const Rectangle &block,
                                                   TraceContext &rays) const;

  private:
    std::vector<Vec3f> visible_points(const Rectangle &pixels, uint32_t count, Sampler &sampler,
                                      TraceContext &rays) const;
    void set_bounds();

    const Scene &scene_;
    InteriorStack around_camera_;
    VplSettings settings_;
};

/// Null where plain paths take over: no medium that scatters, medium that scatters by a narrow peak (Henyey-Greenstein
/// beyond g = -0.6 and 0.9, which all but unbounds the connections), a camera within glass, limits on the depth,
/// nothing finite that shines; medium so dense and white that light wanders through all of the scene, where few of a
/// path's thousands of vertices are near the camera.
std::unique_ptr<const LightVertexCache> plan_light_vertex_cache(const Scene &scene, const DepthLimits &limits,
                                                                const InteriorStack &around_camera);

} // namespace glimmer
