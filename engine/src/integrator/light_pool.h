// SPDX-License-Identifier: GPL-3.0-or-later
// Light vertices shared by all pixels of a pass: when they serve, how many there are, and who prepares them.
#pragma once

#include "integrator/vertex_pool.h"

namespace glimmer {

struct LightPoolBlock final : BlockData {
    LightPoolBlock(const PoolSettings &settings_, VertexPool &&pool_, const Rectangle &pixels_)
        : settings(settings_), pool(std::move(pool_)), pixels(pixels_), splats(size_t(pixels.width) * pixels.height) {}
    /// What the splats of the pass add to a pixel of the block.
    const Rgb &splatted(uint32_t x, uint32_t y) const {
        return splats[size_t(y - pixels.y) * pixels.width + (x - pixels.x)];
    }
    PoolSettings settings;
    VertexPool pool;
    Rectangle pixels;
    std::vector<Rgb> splats; ///< (height, width)
    bool unfinished = false; ///< a light path of the pass was broken off
};

class LightPool {
  public:
    LightPool(const Scene &scene, const GlassStack &around_camera);

    std::unique_ptr<const PassData> prepare_pass(uint64_t seed, uint64_t sample, const std::atomic<bool> &stop,
                                                 RayCounter &rays) const;
    std::unique_ptr<const BlockData> prepare_block(const PassData &pass, const Rectangle &block,
                                                   RayCounter &rays) const;

  private:
    std::vector<Vec3f> seen_points(const Rectangle &pixels, uint32_t count, Sampler &sampler, RayCounter &rays) const;
    void set_bounds();

    const Scene &scene_;
    GlassStack around_camera_;
    PoolSettings settings_;
};

/// Null where plain paths take over: no fog that scatters, fog that scatters by a narrow peak (Henyey-Greenstein
/// beyond g = -0.6 and 0.9, which all but unbounds the connections), a camera within glass, limits on the depth,
/// nothing finite that shines; fog so dense and white that light wanders through all of the scene, where few of a
/// path's thousands of vertices are near the camera.
std::unique_ptr<const LightPool> plan_light_pool(const Scene &scene, const DepthLimits &limits,
                                                 const GlassStack &around_camera);

} // namespace glimmer
