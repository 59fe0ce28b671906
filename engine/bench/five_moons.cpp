// SPDX-License-Identifier: GPL-3.0-or-later
// What generality costs: camera samples of five moons in medium, by the path integrator and by a kernel written by hand
// for grey, isotropic medium, spheres that shine and nothing else. Both draw the same numbers and give the same bits,
// which is checked first. The general one, as compiled for spheres that shine in medium, takes 1.04 of the CPU time
// (1.03 to 1.06 in six runs, medians of 5 to 15, machine busy with other work). It took 1.09 before there were kernels;
// leaving out features alone brought 1.08, inlining all the rest. That the medium is grey and isotropic gains nothing
// more when it is known while compiling.
#include "five_moons.h"

#include "block.h"
#include "camera/camera_sample.h"
#include "integrator/direct/emitter_rays.h"
#include "integrator/path/path_integrator.h"
#include "integrator/return_bound.h"
#include "integrator/roulette.h"
#include "integrator/vpl/light_vertex_cache.h"
#include "light/equiangular_table.h"
#include "light/shapes/sphere.h"

#include <algorithm>
#include <array>
#include <benchmark/benchmark.h>
#include <cmath>

namespace glimmer {
namespace {

constexpr uint32_t kWidth = 96, kHeight = 64, kBlockX = 32, kBlockY = 32; // one block is rendered
constexpr uint32_t kGathers = 8;

BlockWorld &world() {
    static BlockWorld w(five_moons(kWidth, kHeight), {kBlockX, kBlockY, kBlockSize, kBlockSize});
    return w;
}

class Minimal {
  public:
    explicit Minimal(const BlockWorld &w)
        : scene_(w.scene), pool_(static_cast<const LightVertexBlock &>(*w.block)), seen_lights_(w.scene, kLightRays),
          medium_(*w.scene.medium), sigma_s_(medium_.sigma_s.r), sigma_t_(medium_.sigma_t.r) {
        const auto &spheres = w.scene.accel->spheres();
        for (uint32_t i = 0; i < kMoons; ++i) {
            const auto &light = std::get<SphereLight>(w.scene.lights[i]);
            moons_[i] = {spheres[light.index], light.radiance, w.scene.lights.bound(i)};
        }
    }

    FilmSample sample(const CameraRay &camera, Sampler &sampler, TraceContext &rays) const {
        FilmSample result;
        const Ray &ray = camera.ray;
        float end = kInfinity;
        const uint32_t seen = nearest(ray, end);
        const uint32_t rim = seen_lights_.rays(camera.pixel_x, camera.pixel_y);
        const float primary_weight = 1 / float(1 + rim);
        if (seen != kNone)
            result.emission += moons_[seen].radiance * primary_weight * Rgb(transmittance(end));
        for (uint32_t i = 0; i < kMoons; ++i)
            result.medium += light_along(ray, end, i, sampler);
        std::array<Fork, kGathers> forks;
        uint32_t count = 0;
        for (uint32_t k = 0; k < kGathers; ++k) {
            const Collision c =
                sample_collision(medium_, Rgb(1), end, 0, ~0ull / kGathers * k + sampler.next_bits() / kGathers);
            if (!(c.pdf > 0))
                break;
            Fork fork{ray.origin + ray.direction * c.t, ray.direction, c.weight.r * (1 / float(kGathers)), 0, 0};
            if (gather(fork, kGathers, c.t, sampler, rays, result.medium))
                forks[count++] = fork;
        }
        while (count)
            follow(forks[--count], sampler, rays, result.medium);
        if (rim)
            result.emission += seen_lights_.sum(rim, camera.pixel_x, camera.pixel_y, sampler, rays) * primary_weight;
        result.medium += pool_.splatted(camera.pixel_x, camera.pixel_y);
        return result;
    }

  private:
    struct Moon {
        Sphere sphere;
        Rgb radiance;
        LightBound bound;
    };
    /// A short ray from a gather: to where, and how far it counts (light_vertex_cache.h).
    struct Fork {
        Vec3f x, direction;
        float beta, medium_compensation_radius, surface_compensation_radius;
    };

    float transmittance(float t) const { return std::exp(-sigma_t_ * t); }

    uint32_t nearest(const Ray &ray, float &end) const {
        uint32_t hit = kNone;
        const Vec3d origin(ray.origin), direction(ray.direction);
        for (uint32_t i = 0; i < kMoons; ++i)
            if (const auto t = first_root(moons_[i].sphere, origin, direction, double(end))) {
                end = *t;
                hit = i;
            }
        return hit;
    }
    bool occluded(const Ray &ray, uint32_t but) const {
        const Vec3d origin(ray.origin), direction(ray.direction);
        for (uint32_t i = 0; i < kMoons; ++i)
            if (i != but && first_root(moons_[i].sphere, origin, direction, double(ray.t_max)))
                return true;
        return false;
    }

    Rgb light_along(const Ray &ray, float end, uint32_t i, const Sampler &sampler) const {
        const Moon &moon = moons_[i];
        const EquiangularTable line(medium_, ray.origin, ray.direction, end, moon.bound.center, moon.bound.radius);
        const DistanceSample at = line.sample(sampler.stratified_1d(dimension(Dimension::segment_distance, i)));
        if (!(at.pdf > 0) || !(at.t < kInfinity))
            return {};
        const Vec3f x = ray.origin + ray.direction * at.t;
        const auto s = sample_sphere(moon.sphere.center - Vec3d(x), moon.sphere.radius,
                                     sampler.stratified_2d(dimension(Dimension::segment_light, i)));
        if (!s)
            return {};
        const Rgb value = Rgb(sigma_s_) * Rgb(transmittance(at.t + s->distance)) * moon.radiance *
                          (kIsotropicPhase / s->pdf / at.pdf);
        return is_black(value) || occluded({x, s->wi, std::max(s->distance * (1 - 0x1p-21f), 0.0f)}, i) ? Rgb() : value;
    }

    bool survives(float &beta, float rr_scale, const Vec3f &x, Sampler &sampler) const {
        const float weight = std::min(kRouletteScaleAtGathers * beta / rr_scale * return_bound(scene_, x), 1.0f);
        if (!(weight > 0) || (weight < 1 && sampler.next_1d() >= weight))
            return false;
        beta *= weight < 1 ? 1 / weight : 1;
        return true;
    }

    /// Joins a point with the pool and turns the fork into the ray for what bounded connections leave out.
    bool gather(Fork &fork, float scale, float t, Sampler &sampler, TraceContext &rays, Rgb &sum) const {
        if (!survives(fork.beta, 1 / scale, fork.x, sampler))
            return false;
        sum += Rgb(fork.beta) * pool_.vertices.gather(fork.x, fork.direction, sampler, rays);
        const float u = sampler.next_1d();
        const float k = std::sqrt((1 - u) / std::max(u, 1e-12f)) * pool_.settings.clamp_distance_scale(scene_.camera.distance(fork.x));
        fork.medium_compensation_radius = k * pool_.settings.medium_clamp_distance;
        fork.surface_compensation_radius = k * pool_.settings.surface_clamp_distance;
        fork.direction = sample_uniform_sphere(sampler.next_2d());
        if (t > 0) // the general kernel asks whether splats bring what no vertex holds
            sampler.next_1d();
        return true;
    }

    void follow(Fork &fork, Sampler &sampler, TraceContext &rays, Rgb &sum) const {
        do {
            float end = std::max(fork.medium_compensation_radius, fork.surface_compensation_radius);
            nearest({fork.x, fork.direction}, end);
            const FreeFlight flight = sample_free_flight(medium_, Rgb(fork.beta), end, 0, sampler.next_bits());
            if (!flight.scattered || flight.t > fork.medium_compensation_radius)
                return;
            fork.beta *= flight.weight.r;
            fork.x = fork.x + fork.direction * flight.t;
            light(fork, sampler, sum);
        } while (gather(fork, 1, 0, sampler, rays, sum));
    }

    void light(const Fork &fork, Sampler &sampler, Rgb &sum) const {
        const LightChoice choice = scene_.lights.choose(fork.x, sigma_t_, sampler.next_1d());
        const Moon &moon = moons_[choice.index];
        const auto s = sample_sphere(moon.sphere.center - Vec3d(fork.x), moon.sphere.radius, sampler.next_2d());
        if (!s)
            return;
        const Rgb value =
            Rgb(transmittance(s->distance)) * moon.radiance * (kIsotropicPhase / s->pdf / choice.probability);
        if (!is_black(value) && !occluded({fork.x, s->wi, std::max(s->distance * (1 - 0x1p-21f), 0.0f)}, choice.index))
            sum += Rgb(fork.beta) * value;
    }

    const Scene &scene_;
    const LightVertexBlock &pool_;
    EmitterRays seen_lights_;
    HomogeneousMedium medium_;
    float sigma_s_, sigma_t_;
    std::array<Moon, kMoons> moons_;
};

auto general(BlockWorld &w) {
    return [&](const CameraRay &camera, Sampler &sampler) {
        return w.integrator->sample(camera, sampler, w.block.get(), w.rays);
    };
}

void five_moons_general(benchmark::State &state) {
    run_block(state, world(), general(world()));
}

void five_moons_minimal(benchmark::State &state) {
    BlockWorld &w = world();
    const Minimal minimal(w);
    const auto trace = [&](const CameraRay &camera, Sampler &sampler) {
        return minimal.sample(camera, sampler, w.rays);
    };
    if (!same_bits(w, trace, general(w)))
        return state.SkipWithError("the minimal kernel gives other bits than the general one");
    run_block(state, w, trace);
}

BENCHMARK(five_moons_general);
BENCHMARK(five_moons_minimal);

} // namespace
} // namespace glimmer
