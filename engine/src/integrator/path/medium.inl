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
    const bool camera = state.is_camera_segment(), several = state.seen_directly();
    const HenyeyGreenstein phase = medium.phase();
    const Vec3f &origin = state.ray.origin, &direction = state.ray.direction;
    float probability = 1;                  // of sampling at all
    if (!several && has_light_vertices()) { // short segments between surfaces scatter next to nothing
        probability = survival((Rgb(1) - medium.transmittance(state.ray, end)) * state.beta, state.rr_scale, origin,
                               kRouletteScaleInMedium);
        if (!(probability > 0) || (probability < 1 && sampler_.next_1d() >= probability))
            return;
    }
    for (uint32_t i = 0; i < choices(several); ++i) {
        const LightChoice choice = choose(i, several, origin, direction, end);
        if (is_beyond_bounces(choice.index, state.depth))
            continue;
        if (scene().lights.bound(choice.index).infinite)
            continue; // nothing comes through an endless medium
        const EquiangularTable table = equiangular_table(choice.index, origin, direction, end);
        const DistanceSample at = table.sample(
            camera ? sampler_.stratified_1d(dimension(Dimension::segment_distance, i)) : sampler_.next_1d());
        if (!(at.pdf > 0) || !(at.t < kInfinity))
            continue;
        const Vec3f x = origin + direction * at.t;
        const auto light =
            sample_light(choice.index, x,
                         camera ? sampler_.stratified_2d(dimension(Dimension::segment_light, i)) : sampler_.next_2d());
        if (!light || !lights_medium(*light))
            continue;
        const float p_phase = phase.eval(direction, light->direction);
        const Rgb unshadowed =
            medium.scattering(x) *
            medium.transmittance(state.ray, at.t, {x, light->direction, state.ray.time}, light->distance) *
            light->radiance * (p_phase / light->pdf / at.pdf / choice.probability);
        if (is_black(unshadowed))
            continue;
        const Rgb arriving = unshadowed * visibility(x, *light, state.ray.time);
        if (is_black(arriving))
            continue;
        float weight = 1;
        if (!light->delta && !has_light_vertices()) { // nothing else meets lights from gather points
            float p_distance = split ? medium.collision_pdf(state.ray, state.beta, end, at.t)
                                     : medium.free_flight_pdf(state.ray, state.beta, at.t);
            if (p_distance > 0) { // times the probability that a path which scatters there survives roulette
                const Rgb at_collision =
                    state.beta * medium.scattering(x) * medium.transmittance(state.ray, at.t) * (1 / p_distance);
                p_distance *= survival(at_collision, state.rr_scale, x, kRouletteScaleInMedium);
            }
            weight = balance(choice.probability * at.pdf * light->pdf, p_distance * p_phase);
        }
        aov_of_scattering(state, PathClass::medium) += state.beta * arriving * (weight / probability);
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
    const FreeFlight flight = medium.sample_free_flight(state.ray, state.beta, end, sampler_);
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
    const bool along = samples_lights_along(state);
    if (!along)
        sample_light_in_medium(next, x, medium, true);
    else // Roulette belongs to the density by which light is met by chance. Without it, a thin medium would leave a
         // part of the light to one sample in millions.
        pdf *= survival(next.beta, next.rr_scale, x, kRouletteScaleInMedium);
    if (!survives(next, x, kRouletteScaleInMedium))
        return;
    const bool camera = state.is_camera_segment();
    const PhaseSample s = medium.phase().sample(state.ray.direction,
                                                camera ? sampler_.stratified_2d(dimension(Dimension::medium_direction))
                                                       : sampler_.next_2d());
    next.ray = {x, s.direction, state.ray.time};
    next.previous = {ScatterKind::medium,
                     state.seen_directly(),
                     along,
                     s.pdf,
                     x,
                     {state.ray.origin, state.ray.direction, end, t, pdf}};
    next.passed = {};
    set_kind(next, RayKind::volume);
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
void PathSample<F>::sample_light_in_medium(const State &state, const Vec3f &x, const Medium &medium, bool by_chance) {
    if (scene().lights.size() == 0)
        return;
    const LightChoice choice = choose(0, false, x);
    const auto light = sample_light(choice.index, x, sampler_.next_2d());
    if (!light || !lights_medium(*light) || is_beyond_bounces(choice.index, state.depth))
        return;
    const float p_phase = medium.phase().eval(state.ray.direction, light->direction);
    const Rgb unshadowed = medium.transmittance({x, light->direction, state.ray.time}, light->distance) *
                           light->radiance * (p_phase / light->pdf / choice.probability);
    if (is_black(unshadowed))
        return;
    const Rgb arriving = unshadowed * visibility(x, *light, state.ray.time);
    if (is_black(arriving))
        return;
    const float weight = light->delta || !by_chance ? 1 : balance(choice.probability * light->pdf, p_phase);
    aov_of_scattering(state, PathClass::medium) += state.beta * arriving * weight;
}

} // namespace glimmer
