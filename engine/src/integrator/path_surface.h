// SPDX-License-Identifier: GPL-3.0-or-later
// Scattering at surfaces and glass.
#pragma once

#include "integrator/glass_crossing.h"
#include "integrator/held_share.h"
#include "integrator/mis.h"
#include "integrator/path_sample.h"
#include "integrator/shading_frame.h"

#include <array>
#include <cmath>

namespace glimmer {

inline constexpr float kShadowRays = 2;

template <Features F>
void PathSample<F>::note_first_surface(const Interaction &surface) {
    result_.hit = true;
    result_.normal = surface.shading_normal;
    result_.depth = dot(surface.position, scene_.camera.forward);
    result_.object_index = surface.object_index;
    result_.material_index = surface.material + 1;
}

template <Features F>
void PathSample<F>::scatter_at_surface(State &state, const Interaction &surface, Lobes lobes) {
    const Material &material = scene_.materials[surface.material];
    if constexpr (F.glass)
        if (material.kind == MaterialKind::glass) {
            if (lobes != Lobes::held)
                pass_glass(state, surface, material);
            return;
        }
    const Bsdf bsdf = scene_.bsdf(material);
    if (bsdf.empty() || (lobes == Lobes::unheld && is_held(peak(bsdf))))
        return;
    const bool camera = state.depth == 0;
    const Vec3f wo = -state.ray.direction;
    // All materials but glass are two-sided: both normals turn to the viewer.
    const float side = dot(wo, surface.geometric_normal) < 0 ? -1.0f : 1.0f;
    const Vec3f geometric = surface.geometric_normal * side;
    Vec3f shading = surface.shading_normal * side;
    if (!is_above_horizon(shading, wo))
        shading = geometric;
    const Frame frame(shading);
    const Vec3f wo_local = frame.to_local(wo);
    if (!(wo_local.z > 0))
        return;
    if (state.direct_view())
        result_.albedo = albedo(bsdf);

    // Where mirrors could send each branch to the next surface that branches, one goes on.
    const uint32_t branches = state.direct_view() && !has_specular(bsdf) ? options().surface_branches : 1;
    if (!is_specular(bsdf))
        sample_lights_at(state, surface, bsdf, frame, geometric, wo_local, branches, lobes);

    for (uint32_t k = 0; k < branches; ++k) {
        const auto s = sample(bsdf, wo_local, camera ? sampler_.stratified_1d(kSetLobe + 2 * k) : sampler_.next_1d(),
                              camera ? sampler_.stratified_2d(kSetBsdf + 2 * k) : sampler_.next_2d());
        if (!s || (s->specular && lobes == Lobes::held))
            continue;
        const Vec3f wi = normalize(frame.to_world(s->wi));
        if (!(dot(wi, geometric) > 0)) // below the true surface: a shading normal's promise that cannot be kept
            continue;
        State next = state;
        next.beta *= s->weight * (1 / float(branches));
        next.exempt /= float(branches);
        if (lobes != Lobes::all && !s->specular)
            next.beta *= left_of(lobes, held_share(s->weight * s->pdf, wo_local.z, s->wi.z));
        if (!survives(next, surface.position) || (s->specular && !survives_chain(next)))
            continue;
        next.ray = {surface.origin_towards(wi), wi};
        ++next.depth;
        next.origin = {};
        if (s->specular) {
            next.order += state.direct_view() ? 0 : 1;
        } else {
            next.chain = 0;
            next.origin.kind = DirectionKind::surface;
            next.origin.all_lights = every_light(true) || state.direct_view();
            next.origin.pdf = s->pdf * float(branches);
            next.origin.position = lit_point(surface, geometric);
            if (state.direct_view())
                next.first = First::surface;
            ++next.order;
        }
        push(next);
    }
}

template <Features F>
void PathSample<F>::sample_lights_at(const State &state, const Interaction &surface, Bsdf bsdf, const Frame &frame,
                                     const Vec3f &geometric, const Vec3f &wo, uint32_t branches, Lobes lobes) {
    if (scene_.lights.size() == 0)
        return;
    const bool camera = state.depth == 0, all = state.direct_view();
    const Homogeneous *fog = fog_of(state);
    const Vec3f x = lit_point(surface, geometric);
    struct Candidate {
        LightSample light;
        Rgb value; ///< unless hidden
        float part;
    };
    std::array<Candidate, kAllLights> candidates;
    uint32_t count = 0;
    const bool few_rays = !all && every_light(true);
    for (uint32_t i = 0; i < choices(all || few_rays); ++i) {
        const LightChoice choice = choose(i, all || few_rays, x);
        const auto light =
            sample_light(choice.index, x, camera ? sampler_.stratified_2d(kSetLight + i) : sampler_.next_2d());
        if (!light || !(dot(light->direction, geometric) > 0))
            continue;
        const Vec3f wi = frame.to_local(light->direction);
        if (!(wi.z > 0))
            continue;
        const Rgb f_cos = eval(bsdf, wo, wi);
        Rgb value = f_cos * light->radiance * (1 / light->pdf / choice.probability);
        if (fog)
            value *= fog->transmittance(light->distance);
        if (lobes != Lobes::all)
            value *= left_of(lobes, held_share(f_cos, wo.z, wi.z));
        if (!light->delta && !is_black(value))
            value *= balance(choice.probability * light->pdf, float(branches) * pdf(bsdf, wo, wi));
        if (!is_black(value))
            candidates[count++] = {*light, value, value.r + value.g + value.b};
    }
    Rgb &sum = state.first == First::none      ? result_.direct
               : state.first == First::surface ? result_.indirect
                                               : result_.fog;
    float parts = 0;
    for (uint32_t i = 0; i < count; ++i)
        parts += candidates[i].part;
    for (uint32_t i = 0; i < count; ++i) {
        Candidate &c = candidates[i];
        // Beyond the first surface about kShadowRays are spent, on each light by its part of the sum.
        const float tested = few_rays ? std::min(kShadowRays * c.part / parts, 1.0f) : 1.0f;
        if (tested < 1 && !(sampler_.next_1d() < tested))
            continue;
        if (!occluded(surface.origin_towards(c.light.direction), c.light, surface.error))
            sum += state.beta * c.value * (1 / tested);
    }
}

template <Features F>
void PathSample<F>::pass_glass(State &state, const Interaction &surface, const Material &material) {
    const GlassCrossing crossing(surface, material, state.ray.direction, state.glass);
    const GlassSample s = sample_glass(crossing.outgoing, crossing.eta, material.schlick, sampler_.next_1d());
    const Vec3f wi = crossing.to_world(s.wi);
    if (!crossing.possible(wi, s.transmitted))
        return;
    state.beta *= s.weight;
    state.exempt *= s.weight.r;
    if (s.transmitted)
        state.glass = crossing.beyond;
    if (!survives(state, surface.position) || !survives_chain(state))
        return;
    state.ray = {surface.origin_towards(wi), wi};
    state.origin = {};
    state.order += state.direct_view() ? 0 : 1;
    ++state.depth;
    push(state);
}

} // namespace glimmer
