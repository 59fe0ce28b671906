// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/vpl/splat.h"

#include "integrator/visibility.h"
#include "integrator/vpl/tuning.h"
#include "medium/phase.h"
#include "sampling/warp.h"

#include <cmath>

namespace glimmer {

namespace {

/// The crop, widened by the filter.
FilmRectangle film_reached(const FilmSettings &film) {
    const float margin = 0.5f * (film.filter.width() - 1);
    const auto width = float(film.width), height = float(film.height);
    return {{(float(film.crop_x) - margin) / width, (float(film.crop_y) - margin) / height},
            {(float(film.crop_x + film.crop_width) + margin) / width,
             (float(film.crop_y + film.crop_height) + margin) / height}};
}

/// The part of a ray that the film may see. Empty where begin >= end.
RayInterval range_in_picture(const Scene &scene, const Ray &ray) {
    return scene.camera.clip(ray, film_reached(scene.film));
}

/// Splats the point x of the segment, which scatters `power` there.
void splat_point(const Scene &scene, const Vec3f &x, const SubpathSegment &segment, const Rgb &power,
                 const VplSettings &settings, Sampler &sampler, TraceContext &rays, std::vector<Splat> &out) {
    const Vec3f &direction = segment.ray.direction;
    const ShutterTime time = segment.ray.time;
    const Camera &camera = scene.camera;
    const Vec2f u_lens = sampler.next_2d();
    const auto seen = camera.project(x, camera.has_lens() ? sample_uniform_disk(u_lens) : Vec2f{}, time);
    if (!seen)
        return;
    const FilmSettings &film = scene.film;
    const float half = 0.5f * film.filter.width();
    const Ray way{seen->start, seen->direction, time, seen->t};
    const float pixel_area = seen->area(float(film.width) * float(film.height)); // if the filter were a point
    std::optional<Rgb> arriving; // found out where the first pixel asks for it
    const auto found = [&]() -> const Rgb & {
        if (!arriving) {
            arriving = power * scene.medium->transmittance(way, seen->t) *
                       (scene.medium->phase().eval(seen->direction, -direction) *
                        splat_fraction(camera.footprint(seen->t), seen->direction, direction, settings) / pixel_area);
            if (!is_black(*arriving))
                *arriving *= visibility(scene, way, RayKind::camera, rays);
        }
        return *arriving;
    };
    camera.for_each_place(seen->film, [&](Vec2f place) {
        const float u = place.x * float(film.width), v = place.y * float(film.height);
        // The pixels whose filter may hold the point.
        const float left = std::max(std::floor(u - half), float(film.crop_x)),
                    right = std::min(u + half, float(film.crop_x + film.crop_width) - 0.5f),
                    top = std::max(std::floor(v - half), float(film.crop_y)),
                    bottom = std::min(v + half, float(film.crop_y + film.crop_height) - 0.5f);
        for (float py = top; py <= bottom; ++py)
            for (float px = left; px <= right; ++px) {
                const float weight = film.filter.density(u - px - 0.5f) * film.filter.density(v - py - 0.5f);
                if (!(weight > 0))
                    continue;
                if (is_black(found()))
                    return;
                out.push_back({uint32_t(px), uint32_t(py), *arriving * weight, segment.group});
            }
    });
}

} // namespace

bool is_in_picture(const Scene &scene, const Ray &ray) {
    const RayInterval seen = range_in_picture(scene, ray);
    return seen.begin < seen.end;
}

void splat(const Scene &scene, const SubpathSegment &segment, const VplSettings &settings, Sampler &sampler,
           TraceContext &rays, std::vector<Splat> &out) {
    RayInterval seen = range_in_picture(scene, segment.ray);
    const Medium &medium = *scene.medium;
    if (const BoundedMedia *bounded = medium.bounded()) {
        const RayInterval within = bounded->scattering_range(segment.ray, segment.ray.t_max);
        seen = {std::max(seen.begin, within.begin), std::min(seen.end, within.end)};
    }
    if (!(seen.begin < seen.end))
        return;
    const float extinction = medium.least_scattering_extinction();
    for (uint32_t k = 0; k < tuning::kSplatPoints; ++k) {
        const float u = (float(k) + sampler.next_1d()) / float(tuning::kSplatPoints);
        const PointOnRay at = scene.camera.sample_seen(segment.ray, seen, extinction, u);
        const float t = at.t, pdf = at.pdf * float(tuning::kSplatPoints);
        if (!(pdf > 0) || !(t >= 0 && t < kInfinity))
            continue;
        const Vec3f x = segment.ray.origin + segment.ray.direction * t;
        splat_point(scene, x, segment,
                    segment.power * medium.scattering(segment.ray, t) * medium.transmittance(segment.ray, t) *
                        (segment.remainder / pdf),
                    settings, sampler, rays, out);
    }
}

} // namespace glimmer
