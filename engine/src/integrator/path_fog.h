// SPDX-License-Identifier: GPL-3.0-or-later
// Scattering in the fog along a segment.
#pragma once

#include "integrator/mis.h"
#include "integrator/path_sample.h"
#include "medium/phase.h"

#include <cmath>

namespace glimmer {

template <Features F>
void PathSample<F>::sample_lights_along(const State &state, float end, const Homogeneous &fog, bool split) {
    if (scene_.lights.size() == 0)
        return;
    const bool camera = state.depth == 0, all = state.direct_view();
    const HenyeyGreenstein phase{fog.g};
    const Vec3f &origin = state.ray.origin, &direction = state.ray.direction;
    float looked = 1;
    if (!all && pooled()) { // short segments between plates scatter next to nothing: seldom worth a look
        looked = survival((Rgb(1) - fog.transmittance(end)) * state.beta, state.exempt, origin, kSparedInFog);
        if (!(looked > 0) || (looked < 1 && sampler_.next_1d() >= looked))
            return;
    }
    for (uint32_t i = 0; i < choices(all); ++i) {
        const LightChoice choice = choose(i, all, origin, direction, end);
        if (scene_.lights.bound(choice.index).infinite)
            continue; // an endless fog lets nothing through from there
        const LineSampler line = line_sampler(choice.index, origin, direction, end);
        const LineSample at = line.sample(camera ? sampler_.stratified_1d(kSetLine + 2 * i) : sampler_.next_1d());
        if (!(at.pdf > 0) || !(at.t < kInfinity))
            continue;
        const Vec3f x = origin + direction * at.t;
        const auto light =
            sample_light(choice.index, x, camera ? sampler_.stratified_2d(kSetLine + 2 * i + 1) : sampler_.next_2d());
        if (!light)
            continue;
        const float p_phase = phase.eval(direction, light->direction);
        const Rgb unshadowed = fog.sigma_s * fog.transmittance(at.t + light->distance) * light->radiance *
                               (p_phase / light->pdf / at.pdf / choice.probability);
        if (is_black(unshadowed) || occluded(x, *light))
            continue;
        float weight = 1;
        if (!light->delta && !pooled()) { // a pool's gathers are not lit by chance
            float p_distance =
                split ? collision_pdf(fog, state.beta, end, at.t) : free_flight_pdf(fog, state.beta, at.t);
            if (p_distance > 0) { // of the paths that scatter there roulette leaves this part
                const Rgb at_collision = state.beta * fog.sigma_s * fog.transmittance(at.t) * (1 / p_distance);
                p_distance *= survival(at_collision, state.exempt, x, kSparedInFog);
            }
            weight = balance(choice.probability * at.pdf * light->pdf, p_distance * p_phase);
        }
        const Rgb value = state.beta * unshadowed * (weight / looked);
        (state.first == First::surface ? result_.indirect : result_.fog) += value;
    }
}

template <Features F>
void PathSample<F>::split_into_fog(const State &state, float end, const Homogeneous &fog) {
    const bool camera = state.depth == 0;
    const Collision c =
        camera ? sample_collision(fog, state.beta, end, sampler_.next_1d(), sampler_.stratified_bits(kSetCollision))
               : sample_collision(fog, state.beta, end, sampler_);
    if (c.pdf > 0)
        scatter_in_fog(state, end, fog, c.t, c.weight, c.pdf);
}

template <Features F>
bool PathSample<F>::fly_into_fog(State &state, float end, const Homogeneous &fog) {
    const FreeFlight flight = sample_free_flight(fog, state.beta, end, sampler_);
    if (!flight.scattered) {
        state.beta *= flight.weight;
        return false;
    }
    if (flight.pdf > 0)
        scatter_in_fog(state, end, fog, flight.t, flight.weight, flight.pdf);
    return true;
}

template <Features F>
void PathSample<F>::scatter_in_fog(const State &state, float end, const Homogeneous &fog, float t, const Rgb &weight,
                                   float pdf) {
    State next = state;
    next.beta *= weight;
    const Vec3f x = state.ray.origin + state.ray.direction * t;
    const bool along = lights_along(state);
    if (!along)
        sample_light_in_fog(next, x, fog, true);
    else // roulette is part of how light is met by chance: else thin fog keeps a share of it for one sample in millions
        pdf *= survival(next.beta, next.exempt, x, kSparedInFog);
    if (!survives(next, x, kSparedInFog))
        return;
    const bool camera = state.depth == 0;
    const PhaseSample s = HenyeyGreenstein{fog.g}.sample(state.ray.direction, camera ? sampler_.stratified_2d(kSetPhase)
                                                                                     : sampler_.next_2d());
    next.ray = {x, s.direction};
    next.origin = {
        DirectionKind::fog, state.direct_view(), along, s.pdf, x, {state.ray.origin, state.ray.direction, end, t, pdf}};
    ++next.depth;
    ++next.scatter;
    next.chain = 0;
    if (state.direct_view())
        next.first = First::fog;
    ++next.order;
    push(next);
}

template <Features F>
void PathSample<F>::sample_light_in_fog(const State &state, const Vec3f &x, const Homogeneous &fog, bool by_chance) {
    if (scene_.lights.size() == 0)
        return;
    const LightChoice choice = choose(0, false, x);
    const auto light = sample_light(choice.index, x, sampler_.next_2d());
    if (!light)
        return;
    const float p_phase = HenyeyGreenstein{fog.g}.eval(state.ray.direction, light->direction);
    const Rgb unshadowed =
        fog.transmittance(light->distance) * light->radiance * (p_phase / light->pdf / choice.probability);
    if (is_black(unshadowed) || occluded(x, *light))
        return;
    const float weight = light->delta || !by_chance ? 1 : balance(choice.probability * light->pdf, p_phase);
    const Rgb value = state.beta * unshadowed * weight;
    (state.first == First::surface ? result_.indirect : result_.fog) += value;
}

} // namespace glimmer
