// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/direct/emitter_rays.h"

#include "camera/camera_sample.h"
#include "integrator/direct/tuning.h"

#include <cmath>

namespace glimmer {

EmitterRays::EmitterRays(const Scene &scene, uint32_t rays) : scene_(scene), rays_(rays) {
    if (rays == 0)
        return;
    const float margin =
        std::hypot(1.0f, 1 / scene.film.pixel_aspect) * scene.film.filter.width() / float(scene.film.width);
    for (uint32_t i = 0; i < scene.lights.size(); ++i) {
        if (!is_emissive_sphere(scene.lights[i]))
            continue;
        const LightBound &b = scene.lights.bound(i);
        if (const auto disc = scene.camera.silhouette(b.center, b.radius, margin))
            discs_.push_back(*disc);
    }
    if (discs_.size() > tuning::kMostSilhouettes)
        discs_.clear();
}

uint32_t EmitterRays::rays(uint32_t pixel_x, uint32_t pixel_y) const {
    if (discs_.empty())
        return 0;
    const FilmSettings &film = scene_.film;
    const Vec2f middle{(float(int32_t(pixel_x)) + 0.5f) / float(film.width),
                       (float(int32_t(pixel_y)) + 0.5f) / float(film.height)};
    return scene_.camera.sees_any(discs_, middle) ? rays_ : 0;
}

Rgb EmitterRays::sum(uint32_t rays, uint32_t pixel_x, uint32_t pixel_y, ShutterTime time, Sampler &sampler,
                     TraceContext &trace, LightGroups *groups) const {
    const auto side = uint32_t(std::lround(std::sqrt(float(rays))));
    const auto strata = float(side);
    Rgb sum;
    ClosureArena arena;
    for (uint32_t i = 0; i < side * side; ++i) {
        const Vec2f u = sampler.next_2d();
        const Vec2f u_pixel{(float(i % side) + u.x) / strata, (float(i / side) + u.y) / strata};
        const Ray ray = sample_camera_ray(scene_, pixel_x, pixel_y, u_pixel, sampler.next_2d(), time).ray;
        ++trace.rays;
        const auto hit = scene_.accel->intersect(ray, RayKind::camera);
        if (!hit || hit->instance != kNone || scene_.is_holdout(*hit))
            continue;
        Interaction surface = scene_.interaction(ray, *hit);
        arena.clear();
        const Rgb emission = scene_.materials.shade(surface, {-ray.direction, 0, ray.time}, arena).emission;
        const BoundedMedia *varying = scene_.medium ? scene_.medium->bounded() : nullptr;
        const Rgb seen =
            emission * (varying && varying->varies() ? varying->estimate_transmittance(ray, hit->t, sampler)
                                                     : transmittance(scene_.outside(), ray, hit->t));
        sum += seen;
        if (const uint8_t group = scene_.passes_of(*hit).light_group; groups && group)
            (*groups)[group - 1u] += seen;
    }
    return sum;
}

} // namespace glimmer
