// SPDX-License-Identifier: GPL-3.0-or-later
// Scattering in the medium along a segment (docs/method.md, section 11; paths that walk through the medium without
// light vertices are in section 9).
#pragma once

#include "integrator/mis.h"
#include "integrator/path/path_sample.h"
#include "medium/phase.h"

#include <cmath>

namespace glimmer {

template <KernelFeatures F>
void PathSample<F>::sample_lights_along(const State &state, float end, const Medium &medium, bool split) {
    if (scene().lights.size() == 0)
        return;
    const RayInterval range = scattering_range(state, end, medium);
    if (!(range.begin < range.end))
        return;
    const bool camera = state.is_camera_segment(), several = state.seen_directly();
    HenyeyGreenstein phase = medium.phase();
    const Vec3f &direction = state.ray.direction;
    const Vec3f origin = F.bounded_media ? state.ray.origin + direction * range.begin : state.ray.origin;
    const float length = range.end - range.begin;
    float probability = 1;                  // of sampling at all
    if (!several && has_light_vertices()) { // short segments between surfaces scatter next to nothing
        probability = survival((Rgb(1) - medium.transmittance(state.ray, end)) * state.beta, state.rr_scale, origin,
                               kRouletteScaleInMedium);
        if (!(probability > 0) || (probability < 1 && !sampler_.next_bool(probability)))
            return;
    }
    for (uint32_t i = 0; i < choices(several); ++i) {
        const LightChoice choice = choose(i, several, origin, direction, length);
        if (is_beyond_bounces(choice.index, state.depth))
            continue;
        if (scene().lights.bound(choice.index).infinite)
            continue; // of use where a path scatters, if it comes through the medium at all
        const EquiangularTable table = equiangular_table(choice.index, origin, direction, length);
        const DistanceSample at = table.sample(
            camera ? sampler_.stratified_1d(dimension(Dimension::segment_distance, i)) : sampler_.next_1d());
        if (!(at.pdf > 0) || !(at.t < kInfinity))
            continue;
        const Vec3f x = origin + direction * at.t;
        const float t = range.begin + at.t;
        const auto light =
            sample_light(choice.index, x,
                         camera ? sampler_.stratified_2d(dimension(Dimension::segment_light, i)) : sampler_.next_2d());
        if (!light || !lights_medium(*light))
            continue;
        Rgb scattering = medium.scattering(state.ray, t);
        if constexpr (F.bounded_media)
            scattering *= choose_phase(medium, state.ray, t, phase);
        const float p_phase = phase.eval(direction, light->direction);
        const Rgb unshadowed =
            scattering * medium.transmittance(state.ray, t, {x, light->direction, state.ray.time}, light->distance) *
            light->radiance * (p_phase / light->pdf / at.pdf / choice.probability);
        if (is_black(unshadowed))
            continue;
        const Rgb arriving = unshadowed * visibility(x, *light, state.ray.time);
        if (is_black(arriving))
            continue;
        float weight = 1;
        if (!light->delta && !has_light_vertices()) { // nothing else meets lights from gather points
            float p_distance = split ? medium.collision_pdf(state.ray, state.beta, end, t)
                                     : medium.free_flight_pdf(state.ray, state.beta, t);
            if (p_distance > 0) { // times the probability that a path which scatters there survives roulette
                const Rgb at_collision = state.beta * medium.scattering(state.ray, t) *
                                         medium.transmittance(state.ray, t) * (1 / p_distance);
                p_distance *= survival(at_collision, state.rr_scale, x, kRouletteScaleInMedium);
            }
            weight = balance(choice.probability * at.pdf * light->pdf, p_distance * p_phase);
        }
        add_scattered(state, PathClass::medium, state.beta * arriving * (weight / probability),
                      group_of(choice.index, *light));
    }
}

template <KernelFeatures F>
void PathSample<F>::split_into_medium(const State &state, float end, const Medium &medium) {
    const bool camera = state.is_camera_segment();
    const Collision c = camera
                            ? medium.sample_collision(state.ray, state.beta, end, sampler_.next_1d(),
                                                      sampler_.stratified_bits(dimension(Dimension::medium_distance)))
                            : medium.sample_collision(state.ray, state.beta, end, sampler_);
    if (c.pdf > 0)
        scatter_in_medium(state, end, medium, c.t, c.weight, c.pdf);
}

template <KernelFeatures F>
bool PathSample<F>::fly_into_medium(State &state, float end, const Medium &medium) {
    const bool varies = F.varying_media && media_vary_;
    const FreeFlight flight = varies ? medium.bounded()->estimate_free_flight(state.ray, state.beta, end, sampler_)
                                     : medium.sample_free_flight(state.ray, state.beta, end, sampler_);
    if (!flight.scattered) {
        state.beta *= flight.weight;
        return false;
    }
    if (flight.pdf > 0)
        scatter_in_medium(state, end, medium, flight.t, flight.weight, flight.pdf);
    return true;
}

template <KernelFeatures F>
void PathSample<F>::scatter_in_medium(const State &state, float end, const Medium &medium, float t, const Rgb &weight,
                                      float pdf) {
    State next = state;
    next.beta *= weight;
    const Vec3f x = state.ray.origin + state.ray.direction * t;
    HenyeyGreenstein phase = medium.phase();
    if constexpr (F.bounded_media)
        next.beta *= choose_phase(medium, state.ray, t, phase);
    const bool along = samples_lights_along(state);
    float spared = 1;
    if (!along) {
        sample_light_in_medium(next, x, medium, phase, true);
    } else { // Roulette belongs to the density by which light is met by chance. Without it, a thin medium would leave a
             // part of the light to one sample in millions.
        spared = survival(next.beta, next.rr_scale, x, kRouletteScaleInMedium);
        pdf *= spared;
        if (is_lit_from_infinity(medium))
            sample_infinite_lights(next, x, medium, phase, spared);
    }
    if (!survives(next, x, kRouletteScaleInMedium))
        return;
    const bool camera = state.is_camera_segment();
    const PhaseSample s =
        phase.sample(state.ray.direction,
                     camera ? sampler_.stratified_2d(dimension(Dimension::medium_direction)) : sampler_.next_2d());
    const RayInterval range = scattering_range(state, end, medium);
    const Vec3f origin = F.bounded_media ? state.ray.origin + state.ray.direction * range.begin : state.ray.origin;
    next.ray = {x, s.direction, state.ray.time};
    next.previous = {ScatterKind::medium,
                     state.seen_directly(),
                     along,
                     s.pdf,
                     x,
                     {origin, state.ray.direction, range.end - range.begin, t - range.begin, pdf, spared}};
    next.passed = {};
    set_kind(next, RayKind::volume);
    if constexpr (F.passes) {
        next.passes.in_medium |= state.depth == 0;
        next.passes.sees_environment = false;
    }
    ++next.depth;
    ++next.scatter;
    next.specular_depth = 0;
    next.ray_flags = kVolumeScatterRay;
    if (state.seen_directly())
        next.path_class = PathClass::medium;
    ++next.depth_since_first;
    push(next);
}

template <KernelFeatures F>
Rgb PathSample<F>::choose_phase(const Medium &medium, const Ray &ray, float t, HenyeyGreenstein &phase) {
    const BoundedMedia *bounded = medium.bounded();
    if (!bounded)
        return Rgb(1);
    const ScatteringPoint point = bounded->scattering_point(ray, t, sampler_);
    phase = point.phase;
    return point.weight;
}

template <KernelFeatures F>
void PathSample<F>::sample_infinite_lights(const State &state, const Vec3f &x, const Medium &medium,
                                           const HenyeyGreenstein &phase, float survival) {
    const std::vector<uint32_t> &lights = scene().lights.infinite();
    const float share = infinite_light_share();
    const auto n = share < 1 ? size_t(1) : lights.size();
    for (size_t i = 0; i < n; ++i) {
        const size_t picked =
            share < 1 ? std::min(size_t(sampler_.next_1d() * float(lights.size())), lights.size() - 1) : i;
        const auto light = sample_light(lights[picked], x, sampler_.next_2d());
        if (!light || !lights_medium(*light) || is_beyond_bounces(lights[picked], state.depth))
            continue;
        const float p_phase = phase.eval(state.ray.direction, light->direction);
        const Rgb unshadowed = transmittance(medium, {x, light->direction, state.ray.time}, light->distance) *
                               light->radiance * (p_phase / light->pdf / share);
        if (is_black(unshadowed))
            continue;
        const float weight = light->delta ? 1 : balance(share * light->pdf, p_phase * survival);
        add_scattered(state, PathClass::medium,
                      state.beta * unshadowed * visibility(x, *light, state.ray.time) * weight,
                      group_of(lights[picked], *light));
    }
}

template <KernelFeatures F>
void PathSample<F>::sample_light_in_medium(const State &state, const Vec3f &x, const Medium &medium,
                                           const HenyeyGreenstein &phase, bool by_chance) {
    if (scene().lights.size() == 0)
        return;
    const LightChoice choice = choose(0, false, x);
    const auto light = sample_light(choice.index, x, sampler_.next_2d());
    if (!light || !lights_medium(*light) || is_beyond_bounces(choice.index, state.depth))
        return;
    const float p_phase = phase.eval(state.ray.direction, light->direction);
    const Rgb unshadowed = transmittance(medium, {x, light->direction, state.ray.time}, light->distance) *
                           light->radiance * (p_phase / light->pdf / choice.probability);
    if (is_black(unshadowed))
        return;
    const Rgb arriving = unshadowed * visibility(x, *light, state.ray.time);
    if (is_black(arriving))
        return;
    const float weight = light->delta || !by_chance ? 1 : balance(choice.probability * light->pdf, p_phase);
    add_scattered(state, PathClass::medium, state.beta * arriving * weight, group_of(choice.index, *light));
}

} // namespace glimmer
