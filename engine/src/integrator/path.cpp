// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/path.h"

#include "integrator/path_kernels.h"
#include "integrator/seen_lights.h"
#include "integrator/surroundings.h"

namespace glimmer {

namespace {

class PathIntegrator final : public Integrator {
  public:
    PathIntegrator(const Scene &scene, const DepthLimits &limits, const PathOptions &options, bool full_kernel)
        : scene_(scene), limits_(limits), options_(options), around_camera_(glass_around(scene, Vec3f())),
          seen_lights_(scene, around_camera_.empty() && !rays_start_apart() ? kLightRays * options.light_rays : 0) {
        if (options_.light_vertices && options_.line_lights && options_.deep_line_lights)
            pool_ = plan_light_pool(scene, limits, around_camera_);
        plan_ = plan_path(scene, options);
        plan_.light_pixel = plan_.light_pixel && around_camera_.empty() && !rays_start_apart() && limits.depth > 0;
        needed_ = needed_by(scene, options, pool_ != nullptr);
        kernel_ = &path_kernel(full_kernel ? kEverything : needed_);
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
        const auto *pool = static_cast<const LightPoolBlock *>(block);
        const uint32_t light_rays = seen_lights_.rays(camera.pixel_x, camera.pixel_y);
        const float seen_part = 1 / float(1 + light_rays);
        const PathWork work{scene_, limits_, options_, plan_, pool, camera.pixel_x, camera.pixel_y, seen_part};
        FilmSample result = rays_start_apart() ? kernel_->sample(work, camera.ray,
                                                                 glass_around(scene_, camera.ray.origin), sampler, rays)
                                               : kernel_->sample(work, camera.ray, around_camera_, sampler, rays);
        if (light_rays)
            result.emission += seen_lights_.sum(light_rays, camera.pixel_x, camera.pixel_y, sampler, rays) * seen_part;
        if (pool) {
            result.fog += pool->splatted(camera.pixel_x, camera.pixel_y);
            result.unfinished |= pool->unfinished;
        }
        return result;
    }

    std::string kernel() const override {
        const std::string name = options_ == kReportOptions ? "report"
                                 : pool_                    ? "path with shared light vertices"
                                                            : "path";
        return name + " (compiled for " + kernel_->name + ")";
    }
    std::vector<std::string> left_out() const override {
        std::vector<std::string> lines = glimmer::left_out(needed_);
        if (needed_.surfaces && options_.pixel_points && !plan_.light_pixel)
            lines.emplace_back("no surfaces that glint: one point of a pixel is lit, not one of several");
        return lines;
    }

  private:
    /// A lens or the near plane may carry camera rays across a wall of glass.
    bool rays_start_apart() const { return scene_.has_glass && scene_.camera.farthest_start() > 0; }

    const Scene &scene_;
    DepthLimits limits_;
    PathOptions options_;
    GlassStack around_camera_;
    SeenLights seen_lights_;
    std::unique_ptr<const LightPool> pool_;
    PathPlan plan_;
    Features needed_;
    const PathKernel *kernel_ = nullptr;
};

} // namespace

std::unique_ptr<const Integrator> make_path_integrator(const Scene &scene, const DepthLimits &limits,
                                                       const PathOptions &options, bool full_kernel) {
    return std::make_unique<PathIntegrator>(scene, limits, options, full_kernel);
}

} // namespace glimmer
