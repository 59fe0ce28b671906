// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/path/path_integrator.h"

#include "integrator/dielectrics_at.h"
#include "integrator/direct/emitter_rays.h"
#include "integrator/path/kernels.h"

namespace glimmer {

namespace {

class PathIntegrator final : public Integrator {
  public:
    PathIntegrator(const Scene &scene, const DepthLimits &limits, const EstimatorFlags &options, bool full_kernel)
        : scene_(scene), limits_(limits), options_(options),
          around_camera_(dielectrics_at(scene, scene.camera.start_region().center)),
          seen_lights_(scene, around_camera_.empty() && !rays_start_apart() ? kLightRays * options.light_rays : 0) {
        if (options_.light_vertices && options_.segment_lights && options_.deep_segment_lights)
            pool_ = plan_light_vertex_cache(scene, limits, around_camera_);
        plan_ = plan_splitting(scene, options);
        plan_.pixel_ris = plan_.pixel_ris && around_camera_.empty() && !rays_start_apart() && limits.depth > 0;
        needed_ = needed_by(scene, options, pool_ != nullptr);
        kernel_ = &path_kernel(full_kernel ? kAllFeatures : needed_);
    }

    bool shares() const override { return pool_ != nullptr; }
    std::unique_ptr<const WaveData> prepare_wave(uint64_t seed, uint64_t sample, const std::atomic<bool> &stop,
                                                 TraceContext &rays) const override {
        return pool_->prepare_wave(seed, sample, stop, rays);
    }
    std::unique_ptr<const BlockData> prepare_block(const WaveData &pass, const Rectangle &block,
                                                   TraceContext &rays) const override {
        return pool_->prepare_block(pass, block, rays);
    }

    FilmSample sample(const CameraRay &camera, Sampler &sampler, const BlockData *block,
                      TraceContext &rays) const override {
        const auto *pool = static_cast<const LightVertexBlock *>(block);
        const uint32_t light_rays = seen_lights_.rays(camera.pixel_x, camera.pixel_y);
        const float primary_weight = 1 / float(1 + light_rays);
        const PathContext work{scene_, limits_, options_, plan_, pool, camera.pixel_x, camera.pixel_y, primary_weight};
        FilmSample result =
            rays_start_apart()
                ? kernel_->sample(work, camera.ray, dielectrics_at(scene_, camera.ray.origin), sampler, rays)
                : kernel_->sample(work, camera.ray, around_camera_, sampler, rays);
        if (light_rays)
            result.emission +=
                seen_lights_.sum(light_rays, camera.pixel_x, camera.pixel_y, sampler, rays) * primary_weight;
        if (pool) {
            result.medium += pool->splatted(camera.pixel_x, camera.pixel_y);
            result.unfinished |= pool->unfinished;
        }
        return result;
    }

    std::string kernel() const override {
        const std::string name = options_ == kBaselineFlags ? "report"
                                 : pool_                    ? "path with shared light vertices"
                                                            : "path";
        return name + " (compiled for " + kernel_->name + ")";
    }
    std::vector<std::string> left_out() const override {
        std::vector<std::string> lines = glimmer::left_out(needed_);
        if (needed_.surfaces && options_.pixel_points && !plan_.pixel_ris)
            lines.emplace_back("no surfaces that glint: one point of a pixel is lit, not one of several");
        return lines;
    }

  private:
    /// A lens or the near plane may carry camera rays across a wall of glass.
    bool rays_start_apart() const { return scene_.has_dielectrics && scene_.camera.start_region().radius > 0; }

    const Scene &scene_;
    DepthLimits limits_;
    EstimatorFlags options_;
    InteriorStack around_camera_;
    EmitterRays seen_lights_;
    std::unique_ptr<const LightVertexCache> pool_;
    SplittingPlan plan_;
    KernelFeatures needed_;
    const PathKernel *kernel_ = nullptr;
};

} // namespace

std::unique_ptr<const Integrator> make_path_integrator(const Scene &scene, const DepthLimits &limits,
                                                       const EstimatorFlags &options, bool full_kernel) {
    return std::make_unique<PathIntegrator>(scene, limits, options, full_kernel);
}

} // namespace glimmer
