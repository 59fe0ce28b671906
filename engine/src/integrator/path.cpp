// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/path.h"

#include "integrator/path_sample.h"
#include "integrator/surroundings.h"

namespace glimmer {

namespace {

class PathIntegrator final : public Integrator {
  public:
    PathIntegrator(const Scene &scene, const DepthLimits &limits, const PathOptions &options)
        : scene_(scene), limits_(limits), options_(options), around_camera_(glass_around(scene, Vec3f())) {
        if (options_.light_vertices && options_.line_lights && options_.deep_line_lights)
            pool_ = plan_light_pool(scene, limits, around_camera_);
    }

    bool shares() const override { return pool_ != nullptr; }
    std::unique_ptr<const PassData> prepare_pass(uint64_t seed, uint64_t sample, const std::atomic<bool> &stop,
                                                 RayCounter &rays) const override {
        return pool_->prepare_pass(seed, sample, stop, rays);
    }
    std::unique_ptr<const BlockData> prepare_block(const PassData &pass, const Rectangle &block,
                                                   RayCounter &rays) const override {
        return pool_->prepare_block(pass, block, rays);
    }

    FilmSample sample(const CameraRay &camera, Sampler &sampler, const BlockData *block,
                      RayCounter &rays) const override {
        PathState state;
        state.ray = camera.ray;
        // A lens or the near plane may carry the ray across a wall.
        state.glass = scene_.has_glass && scene_.camera.farthest_start() > 0 ? glass_around(scene_, camera.ray.origin)
                                                                             : around_camera_;
        const auto *pool = static_cast<const LightPoolBlock *>(block);
        FilmSample result = PathSample(scene_, limits_, options_, pool, sampler, rays).run(state);
        if (pool) {
            result.fog += pool->splatted(camera.pixel_x, camera.pixel_y);
            result.unfinished |= pool->unfinished;
        }
        return result;
    }

    std::string kernel() const override {
        if (options_ == kReportOptions)
            return "report";
        return pool_ ? "path with shared light vertices" : "path";
    }

  private:
    const Scene &scene_;
    DepthLimits limits_;
    PathOptions options_;
    GlassStack around_camera_;
    std::unique_ptr<const LightPool> pool_;
};

} // namespace

std::unique_ptr<const Integrator> make_path_integrator(const Scene &scene, const DepthLimits &limits,
                                                       const PathOptions &options) {
    return std::make_unique<PathIntegrator>(scene, limits, options);
}

} // namespace glimmer
