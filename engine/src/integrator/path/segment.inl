// SPDX-License-Identifier: GPL-3.0-or-later
// One segment of a path: the emission that it meets, the medium along it, the surface at its end.
#pragma once

#include "integrator/dielectric_crossing.h"
#include "integrator/mis.h"
#include "integrator/path/path_sample.h"
#include "integrator/return_bound.h"
#include "math/rounding.h"

#include <cmath>

namespace glimmer {

template <KernelFeatures F>
void PathSample<F>::follow(State &state) {
    const Medium *medium = medium_of(state);
    if (state.compensates())
        return compensate(state, *medium);
    const std::optional<Hit> hit = intersect(state.ray, kind_of(state));
    const float end = hit ? hit->t : kInfinity;

    add_lamps(state, end, medium);
    if constexpr (F.bounded_media)
        add_medium_emission(state, end, medium);
    std::optional<Interaction> surface;
    Shading shading;
    if (hit && is_held_out(state, *hit)) {
        // Neither the surface nor what is behind it; the medium before it is there.
        pass_empty(state, end, medium);
    } else if (hit) {
        surface = scene().interaction(state.ray, *hit);
        if constexpr (F.surfaces)
            arena_.clear();
        shading = shade(*surface, state.ray, arrival(state, hit->t));
        if constexpr (F.passes)
            if (state.depth == 0 && !result_.hit)
                pass_aovs(state, *surface, hit->t);
        const bool is_behind = F.transparency && (result_.hit || is_mostly_seen_through(shading));
        if (state.seen_directly() && state.depth == 0 && !is_behind)
            note_first_surface(*surface, state.ray.time);
        add_emission(state, *hit, *surface, shading.emission, medium);
    } else {
        if (leaves_empty(state))
            pass_empty(state, kInfinity, medium);
        add_infinity(state, medium);
    }
    const EmissionMode emission_mode = state.emission_mode;
    if (state.depth >= context_.limits.depth || emission_mode == EmissionMode::only) {
        const Ray segment = state.ray;
        if (surface && passes_through(state, *surface, shading, end, true)) {
            if (medium)
                state.beta *= transmittance(*medium, segment, end);
            push(state);
        }
        return;
    }
    state.emission_mode = EmissionMode::mis;

    if (medium && medium->scatters() && state.scatter < context_.limits.scatter) {
        const bool split = splits(state);
        if (samples_lights_along(state))
            sample_lights_along(state, end, *medium, split);
        if (has_light_vertices()) {
            gather_along(state, end, *medium);
        } else if constexpr (F.medium_walks) {
            if (split)
                split_into_medium(state, end, *medium);
            else if (fly_into_medium(state, end, *medium))
                return;
        }
        if (split && surface)
            state.beta *= transmittance(*medium, state.ray, end);
    } else if (medium && surface) {
        state.beta *= transmittance(*medium, state.ray, end);
    }
    if (!surface)
        return;
    if (medium && state.seen_directly()) // absorption before everything dims the picture evenly: no reason to end paths
        state.rr_scale *= medium->least_absorbed(state.ray, end);
    if constexpr (F.passes)
        if (state.depth == 0)
            pass_surface(state, *hit, *surface, shading);
    if (passes_through(state, *surface, shading, end, false)) {
        state.emission_mode = emission_mode;
        return push(state);
    }
    if constexpr (F.surfaces)
        scatter_at_surface(state, *surface, shading);
}

template <KernelFeatures F>
bool PathSample<F>::may_meet_light(const Ray &ray) const {
    if (scene().lights.size() > tuning::kMaxLightsSampledEach)
        return true;
    for (uint32_t i = 0; i < scene().lights.size(); ++i) {
        const LightBound &b = scene().lights.bound(i);
        const Vec3f way = b.center - ray.origin;
        const float radius2 =
            b.radius * b.radius * tuning::kLightBoundFactor + tuning::kLightBoundMargin2 * length_squared(way);
        if (b.infinite || length_squared(way) <= radius2 ||
            (dot(way, ray.direction) > 0 && length_squared(cross(way, ray.direction)) <= radius2))
            return true;
    }
    return false;
}

template <KernelFeatures F>
void PathSample<F>::add_emission(const State &state, const Hit &hit, const Interaction &surface, const Rgb &emission,
                                 const Medium *medium) {
    if (is_black(emission))
        return;
    float weight = 1;
    if (hit.instance == kNone) {
        const uint32_t light = scene().lights.of_sphere(hit.primitive);
        if (context_.parts && state.is_camera_segment()) {
            swap_with(context_.parts->seen, context_.parts->seen_passes);
            add_emitted(state, emission, hit.t, medium, F.passes ? scene().passes_of(hit).light_group : uint8_t(0));
            return swap_with(context_.parts->seen, context_.parts->seen_passes);
        }
        weight = state.is_camera_segment() ? context_.primary_weight : emission_mis_weight(state, light, {hit.t});
        if constexpr (F.transparency && F.meets_lights())
            if (state.emission_mode != EmissionMode::skip && is_far_side(state, hit, surface))
                weight = 1;
    } else if (F.other_lights) {
        const auto [light, triangle] = scene().lights.of_triangle(hit.instance, hit.primitive);
        if (triangle != kNone) {
            const float cosine = std::abs(dot(surface.geometric_normal, state.ray.direction));
            weight = emission_mis_weight(state, light, {state.passed_length() + hit.t, triangle, cosine});
        }
    }
    add_emitted(state, emission * weight, hit.t, medium, F.passes ? scene().passes_of(hit).light_group : uint8_t(0));
}

template <KernelFeatures F>
bool PathSample<F>::is_far_side(const State &state, const Hit &hit, const Interaction &surface) const {
    if (state.passed_length() == 0 || !(dot(state.ray.direction, surface.geometric_normal) > 0))
        return false;
    const Sphere &sphere = scene().accel->spheres()[hit.primitive];
    return length_squared(Vec3d(state.previous.position) - sphere.center) > sphere.radius * sphere.radius;
}

template <KernelFeatures F>
void PathSample<F>::add_lamps(const State &state, float end, const Medium *medium) {
    if (!F.other_lights)
        return;
    Ray ray = state.ray;
    ray.t_max = end;
    for (uint32_t light : scene().lights.intersectable_lamps())
        if (sees_light(state, light))
            if (const auto lamp = intersect_lamp(scene().lights[light], ray))
                add_emitted(state,
                            lamp->radiance * profile(state, light, ray.origin + ray.direction * lamp->t, lamp->t) *
                                emission_mis_weight(state, light, {lamp->t}),
                            lamp->t, medium, scene().lights.flags(light).group);
}

template <KernelFeatures F>
void PathSample<F>::add_medium_emission(const State &state, float end, const Medium *medium) {
    const BoundedMedia *bounded = medium ? medium->bounded() : nullptr;
    if (!bounded || !bounded->emits() || state.emission_mode == EmissionMode::only) // no light sampling finds it
        return;
    const bool varies = F.varying_media && media_vary_;
    add_met(state,
            state.beta *
                (varies ? bounded->estimate_emitted(state.ray, end, sampler_) : bounded->emitted(state.ray, end)),
            0);
}

template <KernelFeatures F>
void PathSample<F>::add_infinity(const State &state, const Medium *medium) {
    if (!F.other_lights)
        return;
    for (uint32_t light : scene().lights.infinite()) {
        if (!sees_light(state, light))
            continue;
        const Rgb radiance = radiance_from_infinity(scene().lights[light], state.ray.direction, state.ray_flags) *
                             profile(state, light, state.ray.direction, kInfinity);
        if (!is_black(radiance))
            add_emitted(state, radiance * emission_mis_weight(state, light, {kInfinity}), kInfinity, medium,
                        scene().lights.flags(light).group,
                        F.passes && std::holds_alternative<EnvironmentLight>(scene().lights[light]));
    }
}

template <KernelFeatures F>
void PathSample<F>::add_emitted(const State &state, const Rgb &radiance, float distance, const Medium *medium,
                                uint8_t group, bool is_environment) {
    const Rgb left = medium ? transmittance(*medium, state.ray, distance) : Rgb(1);
    add_met(state, state.beta * radiance * left, group, is_environment);
}

template <KernelFeatures F>
float PathSample<F>::emission_mis_weight(const State &state, uint32_t light, const LightHit &hit) const {
    if constexpr (F.meets_lights()) {
        const auto &previous = state.previous;
        if (state.emission_mode == EmissionMode::skip)
            return 0;
        if (previous.kind == ScatterKind::specular || light == kNone)
            return 1;
        const float at_light = light_pdf(scene().lights[light], previous.position, state.ray.direction, hit);
        if (previous.kind == ScatterKind::surface && uses_cycles_weights())
            return cycles_weight(previous.pdf, at_light / float(scene().lights.size()));
        if (previous.kind == ScatterKind::surface)
            return balance(previous.pdf,
                           expected_samples(previous.several_lights, light, previous.position) * at_light);
        if (scene().lights.bound(light).infinite && previous.along_segment) {
            if constexpr (F.bounded_media && F.medium_walks) // else there is no end that it could come through
                return balance(previous.pdf * previous.segment.survival, infinite_light_share() * at_light);
            return 1;
        }
        if (!previous.along_segment)
            return balance(previous.pdf, expected_samples(false, light, previous.position) * at_light);
        if constexpr (F.medium_walks) {
            const PreviousSegment &s = previous.segment;
            const EquiangularTable table = equiangular_table(light, s.origin, s.direction, s.end);
            const float samples = expected_samples(previous.several_lights, light, s.origin, s.direction, s.end);
            return balance(s.distance_pdf * previous.pdf, samples * table.pdf(s.distance) * at_light);
        }
    }
    return 1;
}

template <KernelFeatures F>
Rgb PathSample<F>::visibility(const Vec3f &origin, const LightSample &light, ShutterTime time, float origin_offset) {
    if (F.visibility && !light.shadows)
        return Rgb(1);
    const float short_of_light =
        light.distance * (1 - kHitRounding / light.facing) - (light.error + origin_offset) / light.facing;
    const float distance = std::max(short_of_light, 0.0f);
    const Ray ray{origin, light.direction, time, distance};
    return glimmer::visibility<F.bvh>(scene(), ray, RayKind::shadow, trace_, light.ignored_sphere);
}

template <KernelFeatures F>
float PathSample<F>::survival(const Rgb &beta, float rr_scale, const Vec3f &x, float roulette_scale) const {
    const float early = flags().late_roulette ? roulette_scale : 1;
    // Weights of media that vary may be negative.
    const float size =
        F.varying_media ? max_component({std::abs(beta.r), std::abs(beta.g), std::abs(beta.b)}) : max_component(beta);
    const float weight = early * size / rr_scale * return_bound(scene(), x);
    return weight > 0 ? std::min(weight, 1.0f) : 0; // also for NaN
}

template <KernelFeatures F>
bool PathSample<F>::survives(State &state, const Vec3f &x, float roulette_scale) {
    const float weight = survival(state.beta, state.rr_scale, x, roulette_scale);
    if (!(weight > 0))
        return false;
    if (weight == 1)
        return true;
    if (!sampler_.next_bool(weight))
        return false;
    state.beta *= 1 / weight;
    return true;
}

template <KernelFeatures F>
bool PathSample<F>::survives_specular(State &state) {
    const float survival = specular_survival(state.specular_depth++);
    if (survival < 1 && sampler_.next_1d() >= survival)
        return false;
    state.beta *= 1 / survival;
    state.rr_scale *= 1 / survival;
    return true;
}

} // namespace glimmer
