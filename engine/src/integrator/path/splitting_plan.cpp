// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/path/splitting_plan.h"

#include "camera/camera_sample.h"
#include "integrator/direct/ris_target.h"
#include "integrator/path/tuning.h"
#include "integrator/shutter.h"

#include <cmath>

namespace glimmer {

namespace {

constexpr uint64_t kPilotStream = 0x911; // keeps the pilot's random numbers apart from the picture's

} // namespace

double pixel_contrast(const Scene &scene) {
    if (!scene.has_surfaces || scene.lights.size() > LightSet::kWeighedLights)
        return 0;
    Sampler sampler(kPilotStream, 0, 0, 0, 0);
    const FilmSettings &film = scene.film;
    ClosureArena arena;
    const auto target = [&](uint32_t x, uint32_t y) {
        const Ray ray = sample_camera_ray(scene, x, y, sampler.next_2d(), sampler.next_2d(), kMidShutter).ray;
        const auto hit = scene.accel->intersect(ray, RayKind::camera);
        if (!hit)
            return 0.0;
        Interaction surface = scene.interaction(ray, *hit);
        arena.clear();
        const Shading shading = scene.materials.shade(surface, {-ray.direction, 0, ray.time}, arena);
        return double(ris_target(scene, surface, shading.bsdf, -ray.direction, 0));
    };
    double variance = 0, square = 0;
    for (uint32_t i = 0; i < tuning::kContrastPilotPairs; ++i) {
        const Vec2f u = sampler.next_2d();
        const uint32_t x = pick_pixel(film.crop_x, film.crop_width, u.x),
                       y = pick_pixel(film.crop_y, film.crop_height, u.y);
        const double a = target(x, y), b = target(x, y);
        if (!std::isfinite(a) || !std::isfinite(b))
            continue;
        variance += (a - b) * (a - b) / 2;
        square += a * b;
    }
    return square > 0 ? variance / square : 0;
}

SplittingPlan plan_splitting(const Scene &scene, const EstimatorFlags &flags) {
    const bool medium = scene.medium && scene.medium->scatters();
    const bool glints =
        (flags.pixel_ris || (flags.branch && !medium)) && pixel_contrast(scene) > tuning::kContrastOfGlints;
    return {!flags.branch || scene.techniques_differ ? 1
            : medium || glints                       ? tuning::kBranchesWhereVaried
                                                     : tuning::kBranchesElsewhere,
            flags.pixel_ris && glints};
}

} // namespace glimmer
