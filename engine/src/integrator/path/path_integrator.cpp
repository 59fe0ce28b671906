// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/path/path_integrator.h"

#include "film/passes.h"
#include "integrator/dielectrics_at.h"
#include "integrator/direct/emitter_rays.h"
#include "integrator/direct/tuning.h"
#include "integrator/path/kernels.h"
#include "integrator/shutter.h"

namespace glimmer {

namespace {

class PathIntegrator final : public Integrator {
  public:
    PathIntegrator(const Scene &scene, const DepthLimits &limits, const EstimatorFlags &flags, uint64_t passes,
                   bool full_kernel)
        : scene_(scene), limits_(limits), flags_(flags),
          around_camera_(dielectrics_at(scene, scene.camera.start_region().center, kMidShutter, RayKind::camera)),
          // Where a film is transparent, they would shine where alpha is 0.
          emitter_rays_(scene, around_camera_.empty() && !rays_start_apart()
                                   ? tuning::kEmitterRays * (flags.emitter_rays && !scene.film.transparent)
                                   : 0) {
        if (flags_.light_vertices && flags_.equiangular && flags_.deep_equiangular)
            light_vertices_ = plan_light_vertex_cache(scene, limits, around_camera_, (passes & kLightGroupPasses) != 0);
        ambient_occlusion_ = (passes & bit_of(GLIMMER_PASS_AMBIENT_OCCLUSION)) != 0;
        plan_ = plan_splitting(scene, flags);
        plan_.pixel_ris = plan_.pixel_ris && !scene.camera.has_blind_places() && around_camera_.empty() &&
                          !rays_start_apart() && limits.depth > 0;
        needed_ = needed_by(scene, flags, light_vertices_.cache != nullptr, passes);
        KernelFeatures all = kAllFeatures;
        all.passes = needed_.passes;
        kernel_ = &path_kernel(full_kernel ? all : needed_);
    }

    bool shares() const override { return light_vertices_.cache != nullptr; }
    std::unique_ptr<const WaveData> prepare_wave(uint64_t seed, uint64_t sample, TraceContext &trace) const override {
        return light_vertices_.cache->prepare_wave(seed, sample, trace);
    }
    std::unique_ptr<const BlockData> prepare_block(const WaveData &wave, const Rectangle &pixels,
                                                   TraceContext &trace) const override {
        return light_vertices_.cache->prepare_block(wave, pixels, trace);
    }

    bool reconstructs() const override { return flags_.reconstruction; }
    float weight_of_seen(uint32_t pixel_x, uint32_t pixel_y) const override {
        return 1 / float(1 + emitter_rays_.rays(pixel_x, pixel_y));
    }
    FilmSample sample(const CameraRay &camera, Sampler &sampler, const BlockData *block, TraceContext &trace,
                      SampleParts *parts) const override {
        const auto *light_vertices = static_cast<const LightVertexBlock *>(block);
        const uint32_t extra_rays = emitter_rays_.rays(camera.pixel_x, camera.pixel_y);
        const float primary_weight = 1 / float(1 + extra_rays);
        const PathContext context{scene_,         limits_,        flags_,         plan_, light_vertices,
                                  camera.pixel_x, camera.pixel_y, primary_weight, parts, ambient_occlusion_};
        // Where a ray sees nothing its pixel may see something elsewhere: splats and emitter rays.
        FilmSample result =
            camera.is_blind() ? FilmSample()
            : rays_start_apart()
                ? kernel_->sample(context, camera.ray,
                                  dielectrics_at(scene_, camera.ray.origin, camera.ray.time, RayKind::camera), sampler,
                                  trace)
                : kernel_->sample(context, camera.ray, around_camera_, sampler, trace);
        if (parts && !is_in_picture(camera))
            return result;
        FilmSample &own = parts ? parts->own : result;
        PassSample *own_passes = trace.passes && parts ? &parts->own_passes : trace.passes;
        if (extra_rays) {
            LightGroups groups;
            const Rgb seen = emitter_rays_.sum(extra_rays, camera.pixel_x, camera.pixel_y, camera.ray.time, sampler,
                                               trace, own_passes ? &groups : nullptr);
            own.emission += seen * primary_weight;
            if (own_passes) {
                own_passes->emit += seen * primary_weight;
                own_passes->add_groups(groups, Rgb(primary_weight));
            }
        }
        if (light_vertices) {
            const size_t pixel = light_vertices->index(camera.pixel_x, camera.pixel_y);
            const Rgb splatted = light_vertices->splats[pixel];
            own.medium += splatted;
            result.unfinished |= light_vertices->unfinished;
            if (own_passes)
                own_passes->volume_indirect += splatted;
            if (own_passes && light_vertices->settings.grouped)
                own_passes->add_groups(light_vertices->splat_groups[pixel], Rgb(1));
        }
        return result;
    }

    std::string kernel() const override {
        const std::string name = flags_ == kBaselineFlags ? "baseline"
                                 : light_vertices_.cache  ? "path with shared light vertices"
                                                          : "path";
        return name + " (compiled for " + kernel_->name + ")";
    }
    std::vector<std::string> left_out() const override {
        std::vector<std::string> lines = glimmer::left_out(needed_);
        if (needed_.surfaces && flags_.pixel_ris && !plan_.pixel_ris)
            lines.emplace_back("no surfaces that glint: one point of a pixel is lit, not one of several");
        if (!light_vertices_.left_out.empty())
            lines.push_back(light_vertices_.left_out);
        return lines;
    }

  private:
    bool is_in_picture(const CameraRay &camera) const {
        const FilmSettings &film = scene_.film; // pixels before the first are large numbers here
        return camera.pixel_x - film.crop_x < film.crop_width && camera.pixel_y - film.crop_y < film.crop_height;
    }
    /// Whether camera rays start at different places, between which there may be the wall of a dielectric.
    bool rays_start_apart() const {
        return scene_.has_dielectrics && (scene_.camera.start_region().radius > 0 || scene_.moves);
    }

    const Scene &scene_;
    DepthLimits limits_;
    EstimatorFlags flags_;
    InteriorStack around_camera_;
    EmitterRays emitter_rays_;
    LightVertexPlan light_vertices_;
    bool ambient_occlusion_ = false;
    SplittingPlan plan_;
    KernelFeatures needed_;
    const PathKernel *kernel_ = nullptr;
};

} // namespace

std::unique_ptr<const Integrator> make_path_integrator(const Scene &scene, const DepthLimits &limits,
                                                       const EstimatorFlags &flags, uint64_t passes, bool full_kernel) {
    return std::make_unique<PathIntegrator>(scene, limits, flags, passes, full_kernel);
}

} // namespace glimmer
