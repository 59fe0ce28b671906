// SPDX-License-Identifier: GPL-3.0-or-later
// Light scattered more than once, from the vertices of light paths (light_vertex_cache.h).
#pragma once

#include "integrator/path/path_sample.h"
#include "integrator/vpl/bounded_fraction.h"
#include "medium/phase.h"

#include <cmath>

namespace glimmer {

template <KernelFeatures F>
void PathSample<F>::gather_along(const State &state, float end, const Medium &medium) {
    const uint32_t n = state.seen_directly() ? context_.light_vertices->settings.gathers : 1;
    const uint64_t stratum = ~0ull / n;
    for (uint32_t k = 0; k < n; ++k) {
        const uint64_t bits = stratum * k + sampler_.next_bits() / n;
        const Collision c =
            medium.sample_collision(state.ray, state.beta, end, medium.monochromatic() ? 0 : sampler_.next_1d(), bits);
        if (!(c.pdf > 0))
            return;
        push(state);
        State &at = stack_.back();
        at.beta *= c.weight * (1 / float(n));
        at.ray.origin = state.ray.origin + state.ray.direction * c.t;
        at.path_class = state.seen_directly() ? PathClass::medium : state.path_class;
        const float roulette_scale = state.seen_directly() ? kRouletteScaleAtGathers : kRouletteScaleAtSurfaces;
        if (!gather(at, float(n), state.depth == 0 ? c.t : 0, roulette_scale))
            stack_.pop_back();
    }
}

template <KernelFeatures F>
bool PathSample<F>::gather(State &state, float points, float t, float roulette_scale) {
    const Vec3f x = state.ray.origin;
    state.rr_scale /= points;
    if (!survives(state, x, roulette_scale))
        return false;
    state.rr_scale *= points;
    aov_of_scattering(state, PathClass::medium) +=
        state.beta * context_.light_vertices->vertices.gather(x, state.ray.direction, sampler_, trace_);
    const float u = sampler_.next_1d(); // P(k d0(x) > d) = 1 - w(d)
    const float k = std::sqrt((1 - u) / std::max(u, 1e-12f)) *
                    context_.light_vertices->settings.clamp_distance_scale(scene().camera.distance(x));
    state.medium_compensation_radius = k * context_.light_vertices->settings.medium_clamp_distance;
    state.surface_compensation_radius = k * context_.light_vertices->settings.surface_clamp_distance;
    const Vec3f seen = state.ray.direction;
    state.ray = {x, scene().medium->phase().sample(seen, sampler_.next_2d()).direction};
    const float splat = t > 0 ? sampler_.next_1d() : 1;
    if constexpr (F.surfaces) // nothing else sends beams
        state.splatted = t > 0 && splat < splat_fraction(scene().camera.footprint(t), seen, state.ray.direction,
                                                         context_.light_vertices->settings);
    state.previous = {};
    ++state.depth;
    ++state.scatter;
    state.specular_depth = 0;
    ++state.depth_since_first;
    return true;
}

template <KernelFeatures F>
void PathSample<F>::compensate(State &state, const Medium &medium) {
    const float medium_compensation_radius = state.medium_compensation_radius,
                surface_compensation_radius = state.surface_compensation_radius;
    const bool splatted = state.splatted;
    state.medium_compensation_radius = state.surface_compensation_radius = kInfinity;
    state.splatted = false;
    const float reach = splatted || is_bounded(scene().max_value)
                            ? std::max(medium_compensation_radius, surface_compensation_radius)
                            : kInfinity;
    state.ray.t_max = reach;
    const std::optional<Hit> hit = intersect(state.ray);
    const float end = hit ? hit->t : reach;
    state.ray.t_max = kInfinity;
    const FreeFlight flight = medium.sample_free_flight(state.ray, state.beta, end, sampler_);
    state.beta *= flight.weight;
    if (flight.scattered) {
        if (flight.t > medium_compensation_radius)
            return;
        state.ray.origin = state.ray.origin + state.ray.direction * flight.t;
        sample_light_in_medium(state, state.ray.origin, medium, false);
        if (gather(state, 1, 0, kRouletteScaleAtGathers))
            push(state);
    } else if constexpr (F.surfaces) {
        if (!hit)
            return;
        Interaction surface = scene().interaction(state.ray, *hit);
        const bool within = hit->t <= surface_compensation_radius;
        if (within || !splatted)
            scatter_at_surface(state, surface, shade(surface, state.ray).bsdf,
                               !within    ? Lobes::remainder
                               : splatted ? Lobes::bounded
                                          : Lobes::all);
    }
}

} // namespace glimmer
