// SPDX-License-Identifier: GPL-3.0-or-later
// Light that reaches the medium scattered (docs/method.md, sections 3 to 5): bounded connections of gather points to
// the wave's light vertices, and compensation rays for what the bounds take away.
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
    const uint32_t first_subset = context_.light_vertices->vertices.random_subset(sampler_);
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
        if (is_lit_from_infinity(medium))
            light_gather_point_from_infinity(at, medium, state.seen_directly());
        const float roulette_scale = state.seen_directly() ? kRouletteScaleAtGathers : kRouletteScaleAtSurfaces;
        const uint32_t subset = context_.light_vertices->vertices.subset_of(first_subset, k);
        if (!gather(at, float(n), subset, state.depth == 0 ? state.passed_length() + c.t : 0, roulette_scale))
            stack_.pop_back();
    }
}

template <KernelFeatures F>
void PathSample<F>::light_gather_point_from_infinity(const State &at, const Medium &medium, bool certain) {
    const float probability = certain ? 1.0f : survival(at.beta, at.rr_scale, at.ray.origin, kRouletteScaleInMedium);
    if (!(probability > 0) || (probability < 1 && !sampler_.next_bool(probability)))
        return;
    State lit = at;
    lit.beta *= 1 / probability;
    sample_infinite_lights(lit, lit.ray.origin, medium, medium.phase(), 0); // nothing else meets lights from there
}

template <KernelFeatures F>
bool PathSample<F>::gather(State &state, float points, uint32_t subset, float t, float roulette_scale) {
    if (context_.limits.depth - state.depth <
        2) // the depth limit leaves no room for a vertex between here and the light
        return false;
    const Vec3f x = state.ray.origin;
    state.rr_scale /= points;
    if (!survives(state, x, roulette_scale))
        return false;
    state.rr_scale *= points;
    const DepthLimits room{context_.limits.depth - state.depth - 1, context_.limits.scatter - state.scatter - 1};
    LightGroups by_group;
    LightGroups *groups = nullptr;
    if constexpr (F.passes)
        if (trace_.passes && context_.light_vertices->settings.grouped)
            groups = &by_group;
    const Rgb gathered = state.beta * context_.light_vertices->vertices.gather(x, state.ray.direction, subset, room,
                                                                               sampler_, trace_, groups);
    aov_of_scattering(state, PathClass::medium) += gathered;
    if constexpr (F.passes) {
        if (groups)
            trace_.passes->add_groups(by_group, state.beta);
        state.passes.in_medium |= state.depth == 0;
        state.passes.sees_environment = false;
        pass_light(state.passes, gathered, false);
    }
    const VplSettings &settings = context_.light_vertices->settings;
    const float u = sampler_.next_1d(); // P(k d0 > d) = 1 - w(d), equation (3)
    const float k =
        std::sqrt((1 - u) / std::max(u, 1e-12f)) * settings.clamp_distance_scale(scene().camera.distance(x));
    state.medium_compensation_radius = k * settings.medium_clamp_distance;
    state.surface_compensation_radius = k * settings.surface_clamp_distance;
    const Vec3f view = state.ray.direction;
    set_kind(state, RayKind::volume);
    state.ray = {x, scene().medium->phase().sample(view, sampler_.next_2d()).direction, state.ray.time};
    const float u_splat = t > 0 ? sampler_.next_1d() : 1;
    if constexpr (F.surfaces) // without surfaces there are no splats
        state.splatted =
            t > 0 && u_splat < splat_fraction(scene().camera.footprint(t), view, state.ray.direction, settings);
    state.previous = {};
    state.passed = {};
    ++state.depth;
    ++state.scatter;
    state.specular_depth = 0;
    state.ray_flags = kVolumeScatterRay;
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
    if constexpr (F.transparency) // behind a surface that it went through, a ray may have nothing left to bring
        if (!(std::max(medium_compensation_radius, surface_compensation_radius) > 0) &&
            (splatted || is_bounded(scene().max_value)))
            return;
    // Without a splat, the ray also brings the remainder of a BSDF that exceeds its bound, from any distance.
    const float reach = splatted || is_bounded(scene().max_value)
                            ? std::max(medium_compensation_radius, surface_compensation_radius)
                            : kInfinity;
    state.ray.t_max = reach;
    const std::optional<Hit> hit = intersect(state.ray, RayKind::volume);
    const float end = hit ? hit->t : reach;
    state.ray.t_max = kInfinity;
    const FreeFlight flight = state.scatter < context_.limits.scatter
                                  ? medium.sample_free_flight(state.ray, state.beta, end, sampler_)
                                  : FreeFlight{end, false, medium.transmittance(state.ray, end), 1};
    state.beta *= flight.weight;
    if (flight.scattered) {
        if (flight.t > medium_compensation_radius)
            return;
        state.ray.origin = state.ray.origin + state.ray.direction * flight.t;
        sample_light_in_medium(state, state.ray.origin, medium, medium.phase(), false);
        if (gather(state, 1, context_.light_vertices->vertices.random_subset(sampler_), 0, kRouletteScaleAtGathers))
            push(state);
    } else if constexpr (F.surfaces) {
        if (!hit)
            return;
        Interaction surface = scene().interaction(state.ray, *hit);
        arena_.clear();
        const Shading shading = shade(surface, state.ray, arrival(state, hit->t));
        if (passes_through(state, surface, shading, hit->t, false)) {
            state.medium_compensation_radius = medium_compensation_radius - hit->t;
            state.surface_compensation_radius = surface_compensation_radius - hit->t;
            state.splatted = splatted;
            return push(state);
        }
        const bool within = hit->t <= surface_compensation_radius;
        if (within || !splatted)
            scatter_at_surface(state, surface, shading,
                               !within    ? Lobes::remainder
                               : splatted ? Lobes::bounded
                                          : Lobes::all);
    }
}

} // namespace glimmer
