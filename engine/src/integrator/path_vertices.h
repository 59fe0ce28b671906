// SPDX-License-Identifier: GPL-3.0-or-later
// Light scattered more than once, from the vertices of light paths (light_pool.h).
#pragma once

#include "integrator/held_share.h"
#include "integrator/path_sample.h"
#include "medium/phase.h"

#include <cmath>

namespace glimmer {

template <Features F>
void PathSample<F>::gather_along(const State &state, float end, const Homogeneous &fog) {
    const uint32_t n = state.direct_view() ? pool_->settings.gathers : 1;
    const uint64_t stratum = ~0ull / n;
    for (uint32_t k = 0; k < n; ++k) {
        const uint64_t bits = stratum * k + sampler_.next_bits() / n;
        const Collision c = sample_collision(fog, state.beta, end, fog.grey ? 0 : sampler_.next_1d(), bits);
        if (!(c.pdf > 0))
            return;
        push(state);
        State &at = stack_.back();
        at.beta *= c.weight * (1 / float(n));
        at.ray.origin = state.ray.origin + state.ray.direction * c.t;
        at.first = state.direct_view() ? First::fog : state.first;
        const float spared = state.direct_view() ? kSparedAtGathers : kSparedAtSurfaces;
        if (!gather(at, float(n), state.depth == 0 ? c.t : 0, spared))
            stack_.pop_back();
    }
}

template <Features F>
bool PathSample<F>::gather(State &state, float scale, float t, float spared) {
    const Vec3f x = state.ray.origin;
    state.exempt /= scale;
    if (!survives(state, x, spared))
        return false;
    state.exempt *= scale;
    const Rgb value = state.beta * pool_->pool.gather(x, state.ray.direction, sampler_, rays_);
    (state.first == First::surface ? result_.indirect : result_.fog) += value;
    const float u = sampler_.next_1d(); // P(k d0(x) > d) = 1 - w(d)
    const float k = std::sqrt((1 - u) / std::max(u, 1e-12f)) * pool_->settings.widening(x);
    state.fog_reach = k * pool_->settings.fog_bound;
    state.surface_reach = k * pool_->settings.surface_bound;
    const Vec3f seen = state.ray.direction;
    state.ray = {x, HenyeyGreenstein{scene_.medium->g}.sample(seen, sampler_.next_2d()).direction};
    const float splat = t > 0 ? sampler_.next_1d() : 1;
    if constexpr (F.surfaces) // nothing else sends beams
        state.splatted = t > 0 && splat < splat_share(t, seen, state.ray.direction, pool_->settings);
    state.origin = {};
    ++state.depth;
    ++state.scatter;
    state.chain = 0;
    ++state.order;
    return true;
}

template <Features F>
void PathSample<F>::compensate(State &state, const Homogeneous &fog) {
    const float fog_reach = state.fog_reach, surface_reach = state.surface_reach;
    const bool splatted = state.splatted;
    state.fog_reach = state.surface_reach = kInfinity;
    state.splatted = false;
    const float reach = splatted || is_held(scene_.peak) ? std::max(fog_reach, surface_reach) : kInfinity;
    state.ray.t_max = reach;
    const std::optional<Hit> hit = intersect(state.ray);
    const float end = hit ? hit->t : reach;
    state.ray.t_max = kInfinity;
    const FreeFlight flight = sample_free_flight(fog, state.beta, end, sampler_);
    state.beta *= flight.weight;
    if (flight.scattered) {
        if (flight.t > fog_reach)
            return;
        state.ray.origin = state.ray.origin + state.ray.direction * flight.t;
        sample_light_in_fog(state, state.ray.origin, fog, false);
        if (gather(state, 1, 0, kSparedAtGathers))
            push(state);
    } else if constexpr (F.surfaces) {
        if (!hit)
            return;
        const Interaction surface = scene_.interaction(state.ray, *hit);
        const bool within = hit->t <= surface_reach;
        if (within || !splatted)
            scatter_at_surface(state, surface, !within ? Lobes::unheld : splatted ? Lobes::held : Lobes::all);
    }
}

} // namespace glimmer
