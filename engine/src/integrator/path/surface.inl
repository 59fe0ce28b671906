// SPDX-License-Identifier: GPL-3.0-or-later
// Scattering at the surface where a segment ends: its lights, and the paths that go on.
#pragma once

#include "integrator/dielectric_crossing.h"
#include "integrator/mis.h"
#include "integrator/path/path_sample.h"
#include "integrator/shading_frame.h"
#include "integrator/vpl/bounded_fraction.h"

#include <array>
#include <cmath>

namespace glimmer {

template <KernelFeatures F>
void PathSample<F>::note_first_surface(const Interaction &surface) {
    result_.hit = true;
    result_.normal = surface.shading_normal;
    result_.depth = scene().camera.depth(surface.position);
    result_.object_index = surface.object_index;
    result_.material_index = surface.material + 1;
}

template <KernelFeatures F>
auto PathSample<F>::orient(const Interaction &surface, const Vec3f &direction) -> std::optional<OrientedSurface> {
    const Vec3f wo = -direction;
    const float side = dot(wo, surface.geometric_normal) < 0 ? -1.0f : 1.0f;
    const Vec3f geometric = surface.geometric_normal * side;
    Vec3f shading = surface.shading_normal * side;
    if (!is_above_horizon(shading, wo))
        shading = geometric;
    const Frame frame(shading);
    const Vec3f wo_local = frame.to_local(wo);
    if (!(wo_local.z > 0))
        return std::nullopt;
    return OrientedSurface{frame, geometric, wo_local};
}

template <KernelFeatures F>
void PathSample<F>::scatter_at_surface(State &state, const Interaction &surface, Bsdf bsdf, Lobes lobes) {
    const Material &material = scene().materials[surface.material];
    if constexpr (F.dielectrics)
        if (material.kind == MaterialKind::glass) {
            if (lobes != Lobes::bounded)
                cross_dielectric(state, surface, material);
            return;
        }
    if (bsdf.empty() || (lobes == Lobes::remainder && is_bounded(max_value(bsdf))))
        return;
    const bool camera = state.depth == 0;
    const auto oriented_surface = orient(surface, state.ray.direction);
    if (!oriented_surface)
        return;
    const auto &[frame, geometric, wo_local] = *oriented_surface;
    if (state.seen_directly())
        result_.albedo = albedo(bsdf);

    // A mirror could send each branch to another surface that branches in turn, so only one goes on from there.
    const uint32_t branches = state.seen_directly() && !has_specular(bsdf) ? context_.plan.branches : 1;
    const bool lit_by_ris = camera && context_.plan.pixel_ris;
    if (!is_specular(bsdf) && !lit_by_ris)
        sample_lights_at(state, surface, bsdf, *oriented_surface, branches, lobes);

    for (uint32_t k = 0; k < branches; ++k) {
        const auto s = sample(
            bsdf, wo_local, camera ? sampler_.stratified_1d(dimension(Dimension::branch_lobe, k)) : sampler_.next_1d(),
            camera ? sampler_.stratified_2d(dimension(Dimension::branch_direction, k)) : sampler_.next_2d());
        if (!s || (s->specular && lobes == Lobes::bounded))
            continue;
        const Vec3f wi = normalize(frame.to_world(s->wi));
        if (!(dot(wi, geometric) > 0)) // above the shading normal's horizon, but below the true surface
            continue;
        State next = state;
        next.beta *= s->weight * (1 / float(branches));
        next.rr_scale /= float(branches);
        if (lobes != Lobes::all && !s->specular)
            next.beta *= fraction_of(lobes, bounded_fraction(s->weight * s->pdf, wo_local.z, s->wi.z));
        if (!survives(next, surface.position, kRouletteScaleAtSurfaces) || (s->specular && !survives_specular(next)))
            continue;
        next.emission_mode = lit_by_ris && !s->specular ? EmissionMode::skip : EmissionMode::mis;
        if (s->specular)
            leave_specular(next, surface, wi);
        else
            leave_rough(next, surface, geometric, wi, s->pdf * float(branches));
        push(next);
    }
}

template <KernelFeatures F>
void PathSample<F>::leave_specular(State &state, const Interaction &surface, const Vec3f &wi) {
    state.ray = {surface.origin_towards(wi), wi};
    state.previous = {};
    state.depth_since_first += state.seen_directly() ? 0 : 1;
    ++state.depth;
}

template <KernelFeatures F>
void PathSample<F>::leave_rough(State &state, const Interaction &surface, const Vec3f &geometric, const Vec3f &wi,
                                float pdf) {
    state.ray = {surface.origin_towards(wi), wi};
    state.previous = {};
    state.previous.kind = ScatterKind::surface;
    state.previous.several_lights = every_light(true) || state.seen_directly();
    state.previous.pdf = pdf;
    state.previous.position = light_sampling_origin(surface, geometric);
    state.specular_depth = 0;
    if (state.seen_directly())
        state.path_class = PathClass::surface;
    ++state.depth_since_first;
    ++state.depth;
}

template <KernelFeatures F>
void PathSample<F>::light_surface(const State &state, const Interaction &surface, const Shading &shading) {
    const Bsdf bsdf = shading.bsdf;
    const auto oriented_surface = orient(surface, state.ray.direction);
    if (is_specular(bsdf) || !oriented_surface)
        return;
    sample_lights_at(state, surface, bsdf, *oriented_surface, 1, Lobes::all);
    const auto s = sample(bsdf, oriented_surface->wo, sampler_.stratified_1d(dimension(Dimension::candidate_lobe)),
                          sampler_.stratified_2d(dimension(Dimension::candidate_direction)));
    if (!s || s->specular)
        return;
    const Vec3f wi = normalize(oriented_surface->frame.to_world(s->wi));
    if (!(dot(wi, oriented_surface->geometric) > 0))
        return;
    State next = state;
    next.emission_mode = EmissionMode::only;
    next.beta *= s->weight;
    leave_rough(next, surface, oriented_surface->geometric, wi, s->pdf);
    if (may_meet_light(next.ray))
        push(next);
}

template <KernelFeatures F>
void PathSample<F>::sample_lights_at(const State &state, const Interaction &surface, Bsdf bsdf,
                                     const OrientedSurface &oriented_surface, uint32_t branches, Lobes lobes) {
    const auto &[frame, geometric, wo] = oriented_surface;
    if (scene().lights.size() == 0)
        return;
    const bool camera = state.depth == 0, several = state.seen_directly();
    const Medium *medium = medium_of(state);
    const Vec3f x = light_sampling_origin(surface, geometric);
    struct Candidate {
        LightSample light;
        Rgb value; ///< what it brings unless it is hidden
        float part;
    };
    std::array<Candidate, tuning::kMaxLightsSampledEach> candidates;
    uint32_t count = 0;
    const bool few_rays = (!several || (camera && context_.plan.pixel_ris)) && every_light(true);
    for (uint32_t i = 0; i < choices(several || few_rays); ++i) {
        const LightChoice choice = choose(i, several || few_rays, x);
        const auto light =
            sample_light(choice.index, x,
                         camera ? sampler_.stratified_2d(dimension(Dimension::surface_light, i)) : sampler_.next_2d());
        if (!light || !(dot(light->direction, geometric) > 0))
            continue;
        const Vec3f wi = frame.to_local(light->direction);
        if (!(wi.z > 0))
            continue;
        const Rgb f_cos = eval(bsdf, wo, wi);
        Rgb value = f_cos * light->radiance * (1 / light->pdf / choice.probability);
        if (medium)
            value *= medium->transmittance({x, light->direction}, light->distance);
        if (lobes != Lobes::all)
            value *= fraction_of(lobes, bounded_fraction(f_cos, wo.z, wi.z));
        if (!light->delta && !is_black(value))
            value *= balance(choice.probability * light->pdf, float(branches) * pdf(bsdf, wo, wi));
        if (!is_black(value))
            candidates[count++] = {*light, value, value.r + value.g + value.b};
    }
    Rgb &sum = aov_of_scattering(state, PathClass::surface);
    float parts = 0;
    for (uint32_t i = 0; i < count; ++i)
        parts += candidates[i].part;
    for (uint32_t i = 0; i < count; ++i) {
        Candidate &c = candidates[i];
        // Beyond the first surface, each light gets its shadow ray with a probability by its part of the sum.
        const float tested = few_rays ? std::min(tuning::kShadowRaysBeyondFirstSurface * c.part / parts, 1.0f) : 1.0f;
        if (tested < 1 && !(sampler_.next_1d() < tested))
            continue;
        const Vec3f origin = surface.origin_towards(c.light.direction);
        const Rgb arriving = c.value * visibility(origin, c.light, surface.error);
        if (!is_black(arriving))
            sum += state.beta * arriving * (1 / tested);
    }
}

template <KernelFeatures F>
void PathSample<F>::cross_dielectric(State &state, const Interaction &surface, const Material &material) {
    const DielectricCrossing crossing(surface, material, state.ray.direction, state.interior);
    const DielectricSample s = sample_dielectric(crossing.outgoing, crossing.eta, material.schlick, sampler_.next_1d());
    const Vec3f wi = crossing.to_world(s.wi);
    if (!crossing.possible(wi, s.transmitted))
        return;
    state.beta *= s.weight;
    state.rr_scale *= s.weight.r;
    if (s.transmitted)
        state.interior = crossing.beyond;
    if (!survives(state, surface.position, kRouletteScaleAtSurfaces) || !survives_specular(state))
        return;
    leave_specular(state, surface, wi);
    push(state);
}

} // namespace glimmer
