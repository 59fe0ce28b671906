// SPDX-License-Identifier: GPL-3.0-or-later
// One segment of a path: what stands at its end, what shines on the way.
#pragma once

#include "integrator/glass_crossing.h"
#include "integrator/mis.h"
#include "integrator/path_sample.h"
#include "integrator/surroundings.h"

#include <cmath>

namespace glimmer {

template <Features F>
void PathSample<F>::follow(State &state) {
    const Homogeneous *fog = fog_of(state);
    if (state.compensates())
        return compensate(state, *fog);
    const std::optional<Hit> hit = intersect(state.ray);
    const float end = hit ? hit->t : kInfinity;

    add_lamps(state, end, fog);
    std::optional<Interaction> surface;
    if (hit) {
        surface = scene_.interaction(state.ray, *hit);
        if (state.direct_view() && state.depth == 0)
            note_first_surface(*surface);
        add_emission(state, *hit, *surface, fog);
    } else {
        add_infinity(state, fog);
    }
    if (state.depth >= limits_.depth || state.met == Met::alone)
        return;
    state.met = Met::counted;

    if (fog && fog->scatters() && state.scatter < limits_.scatter) {
        const bool split = pooled() || (options().split && state.direct_view() && stack_.size() < kBranches);
        if (lights_along(state))
            sample_lights_along(state, end, *fog, split);
        if (pooled()) {
            gather_along(state, end, *fog);
        } else if constexpr (F.fog_walks) {
            if (split)
                split_into_fog(state, end, *fog);
            else if (fly_into_fog(state, end, *fog))
                return;
        }
        if (split && surface)
            state.beta *= fog->transmittance(end);
    } else if (fog && surface) {
        state.beta *= fog->transmittance(end);
    }
    if (!surface)
        return;
    if (fog && state.direct_view()) // an absorber in front of everything dims the picture, not what is behind it
        state.exempt *= least_absorbed(*fog, end);
    if constexpr (F.surfaces)
        scatter_at_surface(state, *surface);
}

template <Features F>
bool PathSample<F>::may_meet_light(const Ray &ray) const {
    if (scene_.lights.size() > kAllLights)
        return true;
    for (uint32_t i = 0; i < scene_.lights.size(); ++i) {
        const LightBound &b = scene_.lights.bound(i);
        const Vec3f way = b.center - ray.origin;
        constexpr float kWider = 1.001f; // than all rounding, at the price of a ray now and then
        const float radius2 = b.radius * b.radius * kWider + 1e-6f * length_squared(way);
        if (b.infinite || length_squared(way) <= radius2 ||
            (dot(way, ray.direction) > 0 && length_squared(cross(way, ray.direction)) <= radius2))
            return true;
    }
    return false;
}

template <Features F>
void PathSample<F>::add_emission(const State &state, const Hit &hit, const Interaction &surface,
                                 const Homogeneous *fog) {
    const Rgb &emission = scene_.materials[surface.material].emission;
    if (is_black(emission))
        return;
    float weight = 1;
    if (hit.instance == kNone) {
        const uint32_t light = scene_.lights.of_sphere(hit.primitive);
        weight = state.depth == 0 ? seen_part_ : direction_weight(state, light, kNone, hit.t, 1);
    } else if (F.other_lights && scene_.lights.of_meshes() != kNone) {
        const auto &mesh = std::get<MeshLight>(scene_.lights[scene_.lights.of_meshes()]);
        const uint32_t triangle = mesh.triangle_of[mesh.first_of_instance[hit.instance] + hit.primitive];
        if (triangle != kNone)
            weight = direction_weight(state, scene_.lights.of_meshes(), triangle, hit.t,
                                      std::abs(dot(surface.geometric_normal, state.ray.direction)));
    }
    add_seen(state, emission * weight, hit.t, fog);
}

template <Features F>
void PathSample<F>::add_lamps(const State &state, float end, const Homogeneous *fog) {
    if (!F.other_lights || state.depth == 0) // the camera does not see lamps
        return;
    Ray ray = state.ray;
    ray.t_max = end;
    for (uint32_t light : scene_.lights.lamps())
        if (const auto lamp = intersect_lamp(scene_.lights[light], ray))
            add_seen(state, lamp->radiance * direction_weight(state, light, kNone, lamp->t, 1), lamp->t, fog);
}

template <Features F>
void PathSample<F>::add_infinity(const State &state, const Homogeneous *fog) {
    if (!F.other_lights)
        return;
    for (uint32_t light : scene_.lights.infinite()) {
        const bool sun = std::holds_alternative<SunLamp>(scene_.lights[light]);
        if (sun && state.depth == 0)
            continue;
        const Rgb radiance = radiance_from_infinity(scene_.lights[light], state.ray.direction);
        if (!is_black(radiance))
            add_seen(state, radiance * direction_weight(state, light, kNone, kInfinity, 1), kInfinity, fog);
    }
}

template <Features F>
void PathSample<F>::add_seen(const State &state, const Rgb &radiance, float distance, const Homogeneous *fog) {
    const Rgb value = state.beta * radiance * (fog ? fog->transmittance(distance) : Rgb(1));
    switch (state.first) {
    case First::none:
        result_.emission += value;
        break;
    case First::fog:
        result_.fog += value;
        break;
    case First::surface:
        (state.order == 1 ? result_.direct : result_.indirect) += value;
    }
}

template <Features F>
float PathSample<F>::direction_weight(const State &state, uint32_t light, uint32_t triangle, float distance,
                                      float cosine) const {
    if constexpr (F.meets_lights()) {
        const auto &o = state.origin;
        if (state.met == Met::elsewhere)
            return 0;
        if (o.kind == DirectionKind::specular || light == kNone)
            return 1;
        const float at_light =
            light_pdf(scene_.lights[light], o.position, state.ray.direction, triangle, distance, cosine);
        if (o.kind == DirectionKind::surface)
            return balance(o.pdf, expected_samples(o.all_lights, light, o.position) * at_light);
        if (scene_.lights.bound(light).infinite)
            return 1;
        if (!o.along)
            return balance(o.pdf, expected_samples(false, light, o.position) * at_light);
        if constexpr (F.fog_walks) {
            const SegmentOrigin &s = o.segment;
            const LineSampler line = line_sampler(light, s.origin, s.direction, s.end);
            const float samples = expected_samples(o.all_lights, light, s.origin, s.direction, s.end);
            return balance(s.distance_pdf * o.pdf, samples * line.pdf(s.distance) * at_light);
        }
    }
    return 1;
}

template <Features F>
bool PathSample<F>::occluded(const Vec3f &origin, const LightSample &light, float moved) {
    ++rays_.rays;
    constexpr float direction_error = 0x1p-21f; // of a unit vector in float32, and of Embree's own arithmetic
    const float short_of_light =
        light.distance * (1 - direction_error / light.facing) - (light.error + moved) / light.facing;
    const float distance = std::max(short_of_light, 0.0f);
    const Ray ray{origin, light.direction, distance};
    return F.bvh ? scene_.accel->occluded(ray, light.ignored_sphere)
                 : scene_.accel->occluded_by_few(ray, light.ignored_sphere);
}

template <Features F>
float PathSample<F>::survival(const Rgb &beta, float exempt, const Vec3f &x, float spared) const {
    const float early = options().late_roulette ? spared : 1;
    const float weight = early * max_component(beta) / exempt * surroundings_importance(scene_, x);
    return weight > 0 ? std::min(weight, 1.0f) : 0; // NaN does not live on
}

template <Features F>
bool PathSample<F>::survives(State &state, const Vec3f &x, float spared) {
    const float weight = survival(state.beta, state.exempt, x, spared);
    if (!(weight > 0))
        return false;
    if (weight == 1)
        return true;
    if (sampler_.next_1d() >= weight)
        return false;
    state.beta *= 1 / weight;
    return true;
}

template <Features F>
bool PathSample<F>::survives_chain(State &state) {
    const float survival = survival_of_chain(state.chain++);
    if (survival < 1 && sampler_.next_1d() >= survival)
        return false;
    state.beta *= 1 / survival;
    state.exempt *= 1 / survival;
    return true;
}

} // namespace glimmer
