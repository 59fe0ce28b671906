// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/vpl/splat.h"

#include "camera/camera_sample.h"
#include "medium/equiangular.h"
#include "medium/phase.h"
#include "sampling/warp.h"

#include <cmath>

namespace glimmer {

namespace {

constexpr uint32_t kPoints = 2; // on a beam

struct Range {
    float begin, end;
};

/// The part of a beam that a pinhole sees within the crop, widened by the filter. With a lens, all of it.
Range primary_weight(const Scene &scene, const Ray &beam) {
    const Camera &camera = scene.camera;
    const FilmSettings &film = scene.film;
    Range seen{0, beam.t_max};
    // The side of a plane where p.normal >= offset.
    const auto clip = [&](const Vec3f &normal, float offset) {
        const float at = dot(beam.origin, normal) - offset, slope = dot(beam.direction, normal);
        if (slope > 0)
            seen.begin = std::max(seen.begin, -at / slope);
        else if (slope < 0)
            seen.end = std::min(seen.end, -at / slope);
        else if (at < 0)
            seen.end = -1;
    };
    clip(camera.forward, camera.clip_start);
    if (camera.lens_radius > 0)
        return seen;
    const float margin = 0.5f * (film.filter_width - 1);
    const auto slope_x = [&](float u) {
        return (2 * (u / float(film.width) + camera.shift.x) - 1) * camera.tan_half_x;
    };
    const auto slope_y = [&](float v) {
        return ((1 - 2 * v / float(film.height)) * camera.aspect + 2 * camera.shift.y) * camera.tan_half_x;
    };
    clip(camera.right - camera.forward * slope_x(float(film.crop_x) - margin), 0);
    clip(camera.forward * slope_x(float(film.crop_x + film.crop_width) + margin) - camera.right, 0);
    clip(camera.forward * slope_y(float(film.crop_y) - margin) - camera.up, 0);
    clip(camera.up - camera.forward * slope_y(float(film.crop_y + film.crop_height) + margin), 0);
    return seen;
}

/// A point that scatters `power`, which arrives along `direction`.
void splat_point(const Scene &scene, const Vec3f &x, const Vec3f &direction, const Rgb &power,
                 const VplSettings &settings, Sampler &sampler, TraceContext &rays, std::vector<Splat> &out) {
    const Camera &camera = scene.camera;
    const Vec2f u_lens = sampler.next_2d();
    const auto seen = camera.project(x, camera.lens_radius > 0 ? sample_uniform_disk(u_lens) : Vec2f{});
    if (!seen)
        return;
    const FilmSettings &film = scene.film;
    const float u = seen->film.x * float(film.width), v = seen->film.y * float(film.height);
    const float half = 0.5f * film.filter_width;
    // Pixels whose filter may hold the point.
    const float left = std::max(std::floor(u - half), float(film.crop_x)),
                right = std::min(u + half, float(film.crop_x + film.crop_width) - 0.5f),
                top = std::max(std::floor(v - half), float(film.crop_y)),
                bottom = std::min(v + half, float(film.crop_y + film.crop_height) - 0.5f);
    if (!(left <= right && top <= bottom))
        return;
    const float pixel_angle =
        seen->solid_angle / (float(film.width) * float(film.height)); // at this place, if the filter were a point
    const Rgb radiance =
        power * scene.medium->transmittance(seen->t) *
        (HenyeyGreenstein{scene.medium->g}.eval(seen->direction, -direction) *
         splat_share(seen->t, seen->direction, direction, settings) / (seen->distance * seen->distance * pixel_angle));
    if (is_black(radiance))
        return;
    bool visible = false;
    for (float py = top; py <= bottom; ++py)
        for (float px = left; px <= right; ++px) {
            const float weight = filter_density(film, u - px - 0.5f) * filter_density(film, v - py - 0.5f);
            if (!(weight > 0))
                continue;
            if (!visible) {
                ++rays.rays;
                if (scene.accel->occluded({seen->start, seen->direction, seen->t}))
                    return;
                visible = true;
            }
            out.push_back({uint32_t(px), uint32_t(py), radiance * weight});
        }
}

} // namespace

bool is_seen(const Scene &scene, const Ray &beam) {
    const Range seen = primary_weight(scene, beam);
    return seen.begin < seen.end;
}

void splat(const Scene &scene, const SubpathSegment &beam, const VplSettings &settings, Sampler &sampler,
           TraceContext &rays, std::vector<Splat> &out) {
    const Range seen = primary_weight(scene, beam.ray);
    if (!(seen.begin < seen.end))
        return;
    const HomogeneousMedium &medium = *scene.medium;
    const float foot = -dot(beam.ray.origin, beam.ray.direction); // nearest to the camera, which stands at the origin
    const Equiangular along(seen.begin - foot, seen.end - foot, length(beam.ray.origin + beam.ray.direction * foot));
    for (uint32_t k = 0; k < kPoints; ++k) {
        const float from_foot = along.sample((float(k) + sampler.next_1d()) / kPoints), t = from_foot + foot;
        const float pdf = along.pdf(from_foot) * kPoints;
        if (!(pdf > 0) || !(t >= 0 && t < kInfinity))
            continue;
        splat_point(scene, beam.ray.origin + beam.ray.direction * t, beam.ray.direction,
                    beam.power * medium.sigma_s * medium.transmittance(t) * (beam.remainder / pdf), settings, sampler,
                    rays, out);
    }
}

} // namespace glimmer
