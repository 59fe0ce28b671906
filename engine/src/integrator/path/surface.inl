// SPDX-License-Identifier: GPL-3.0-or-later
// Scattering at the surface where a segment ends: its lights, and the paths that go on.
#pragma once

#include "integrator/dielectric_crossing.h"
#include "integrator/mis.h"
#include "integrator/path/path_sample.h"
#include "integrator/shading_frame.h"
#include "integrator/shadow_terminator.h"
#include "integrator/subsurface_walk.h"
#include "integrator/vpl/bounded_fraction.h"

#include <array>
#include <cmath>

namespace glimmer {

template <KernelFeatures F>
void PathSample<F>::note_first_surface(const Interaction &surface, ShutterTime time) {
    result_.hit = true;
    result_.normal = surface.shading_normal;
    result_.depth = scene().camera.depth(surface.position, time);
    result_.object_index = surface.object_index;
    result_.material_index = surface.material + 1;
    if constexpr (F.passes)
        pass_first_surface(surface, time);
}

template <KernelFeatures F>
auto PathSample<F>::orient(const State &state, const Interaction &surface, const Shading &shading) const
    -> std::optional<OrientedSurface> {
    if constexpr (F.transmission)
        if (shading.interior_ior > 0) {
            const DielectricCrossing crossing(scene(), surface, shading.interior_ior, state.ray.direction,
                                              state.interior);
            return OrientedSurface{crossing.frame, crossing.geometric, crossing.outgoing, crossing.eta,
                                   true,           crossing.beyond};
        }
    const Vec3f wo = -state.ray.direction;
    if (surface.softening != BumpSoftening::none) [[unlikely]]
        return orient_bumped(surface, shading.bsdf, wo);
    const float side = dot(wo, surface.geometric_normal) < 0 ? -1.0f : 1.0f;
    const Vec3f geometric = surface.geometric_normal * side;
    const Frame frame(normal_towards(surface.shading_normal * side, geometric, wo, shading.bsdf,
                                     F.medium && scene().medium.has_value()));
    const Vec3f wo_local = frame.to_local(wo);
    if (!(wo_local.z > 0))
        return std::nullopt;
    return OrientedSurface{frame, geometric, wo_local};
}

template <KernelFeatures F>
auto PathSample<F>::orient_bumped(const Interaction &surface, const Bsdf &bsdf, const Vec3f &wo) -> OrientedSurface {
    const float side = dot(wo, surface.geometric_normal) < 0 ? -1.0f : 1.0f;
    const Vec3f geometric = surface.geometric_normal * side;
    bool bends = surface.softening == BumpSoftening::cubic; // in later versions diffuse lobes alone do not ask for it
    for (const WeightedLobe &l : bsdf)
        bends |= !is_diffuse(l.lobe);
    const Vec3f bumped = surface.shading_normal * side;
    const Frame frame(bends ? bent_to_reflect(bumped, geometric, wo) : bumped);
    Vec3f outgoing = frame.to_local(wo);
    outgoing.z = std::max(outgoing.z, 1e-4f); // a bump that turns away from the eye is seen all the same
    OrientedSurface at{frame, geometric, outgoing};
    at.bump = {frame.to_local(surface.smooth_normal * side), surface.softening};
    return at;
}

template <KernelFeatures F>
void PathSample<F>::scatter_at_surface(State &state, const Interaction &surface, const Shading &shading, Lobes lobes) {
    Bsdf bsdf = shading.bsdf;
    if (bsdf.empty() || (lobes == Lobes::remainder && is_bounded(max_value(bsdf))))
        return;
    const bool clear_glass = F.transmission && is_smooth_dielectric(bsdf); // one number samples it
    if (clear_glass && lobes == Lobes::bounded)
        return;
    const bool camera = state.is_camera_segment();
    const auto oriented_surface = orient(state, surface, shading);
    if (!oriented_surface)
        return;
    set_surface(bsdf, *oriented_surface);
    const Frame &frame = oriented_surface->frame;
    const Vec3f &geometric = oriented_surface->geometric, &wo_local = oriented_surface->wo;
    if (state.seen_directly() && !clear_glass)
        result_.albedo = albedo(bsdf);

    // A mirror could send each branch to another surface that branches in turn, so only one goes on from there.
    const uint32_t branches = state.seen_directly() && !has_specular(bsdf) ? context_.plan.branches : 1;
    const bool lit_by_ris = camera && context_.plan.pixel_ris;
    if (!is_specular(bsdf) && !lit_by_ris)
        sample_lights_at(state, surface, bsdf, *oriented_surface, branches, lobes);

    for (uint32_t k = 0; k < branches; ++k) {
        const auto s = clear_glass ? sample(bsdf, wo_local, sampler_.next_1d(), {})
                                   : sample(bsdf, wo_local,
                                            camera ? sampler_.stratified_1d(dimension(Dimension::branch_lobe, k))
                                                   : sampler_.next_1d(),
                                            camera ? sampler_.stratified_2d(dimension(Dimension::branch_direction, k))
                                                   : sampler_.next_2d());
        if (!s || (s->specular && lobes == Lobes::bounded))
            continue;
        const Vec3f wi = normalize(frame.to_world(s->wi));
        if (!is_on_side(*s, wi, geometric))
            continue;
        State next = state;
        next.beta *= s->weight * (1 / float(branches));
        next.rr_scale /= float(branches);
        if constexpr (F.subsurface)
            if (const auto *beneath = std::get_if<Subsurface>(&bsdf[s->lobe].lobe)) {
                scatter_beneath(next, *beneath, surface, geometric, wi);
                continue;
            }
        if (lobes != Lobes::all && !s->specular)
            next.beta *= fraction_of(lobes, vertex_fraction(*oriented_surface, s->weight * s->pdf, s->wi));
        if (s->transmitted)
            cross_boundary(next, *oriented_surface);
        if (!survives(next, surface.position, kRouletteScaleAtSurfaces) || (s->specular && !survives_specular(next)))
            continue;
        if constexpr (F.passes)
            set_shares(next, state, bsdf, wo_local, *s, scene());
        next.ray_flags = ray_flags(*s);
        next.emission_mode = lit_by_ris && !s->specular ? EmissionMode::skip : EmissionMode::mis;
        set_kind(next, kind_of(*s));
        if (s->specular)
            leave_specular(next, surface, wi);
        else
            leave_rough(next, surface, geometric, wi, s->pdf * float(branches));
        push(next);
    }
}

template <KernelFeatures F>
void PathSample<F>::scatter_beneath(State state, const Subsurface &lobe, const Interaction &surface,
                                    const Vec3f &geometric, const Vec3f &wi) {
    auto exit = walk_beneath(scene(), lobe, surface, geometric, wi, state.beta, state.ray.time, sampler_, trace_);
    if (!exit)
        return;
    state.beta *= exit->weight;
    Interaction &at = exit->surface;
    if (scene().materials[at.material].varying != Material::kConstant) // which may turn the normal
        scene().materials.shade(at, {exit->outward, 0, state.ray.time}, arena_);
    const float side = std::copysign(1.0f, dot(exit->outward, at.geometric_normal));
    const OrientedSurface oriented{Frame(at.shading_normal * side), exit->outward, {0, 0, 1}};
    const Lobe leaving =
        lobe.boundary == SubsurfaceBoundary::burley ? Lobe(Burley{Rgb(1), 0, BurleyPart::base}) : Lobe(Lambert{Rgb(1)});
    const WeightedLobe whole{leaving, 1, 1};
    const Bsdf bsdf(std::span(&whole, 1));
    state.passed += 1; // no more the camera's own ray, whose numbers the other branches and lobes draw
    sample_lights_at(state, at, bsdf, oriented, 1, Lobes::all);
    const auto s = sample(bsdf, oriented.wo, 0, sampler_.next_2d());
    if (!s)
        return;
    const Vec3f direction = normalize(oriented.frame.to_world(s->wi));
    state.beta *= s->weight;
    if (!is_on_side(*s, direction, oriented.geometric) || !survives(state, at.position, kRouletteScaleAtSurfaces))
        return;
    if constexpr (F.passes)
        set_shares(state, state, bsdf, oriented.wo, *s, scene());
    state.ray_flags = kReflectionRay | kDiffuseRay;
    state.emission_mode = EmissionMode::mis;
    set_kind(state, RayKind::diffuse);
    leave_rough(state, at, oriented.geometric, direction, s->pdf);
    push(state);
}

template <KernelFeatures F>
bool PathSample<F>::is_on_side(const BsdfSample &s, const Vec3f &wi, const Vec3f &geometric) {
    const float cosine = dot(wi, geometric);
    return F.transmission && s.transmitted ? cosine < 0 : cosine > 0;
}

template <KernelFeatures F>
float PathSample<F>::vertex_fraction(const OrientedSurface &at, const Rgb &f_cos, const Vec3f &wi) {
    if (F.transmission && at.bounds_interior && wi.z < 0)
        return 0;
    return bounded_fraction(f_cos, at.wo.z, std::abs(wi.z));
}

template <KernelFeatures F>
void PathSample<F>::cross_boundary(State &state, const OrientedSurface &at) {
    if constexpr (F.transmission)
        if (at.bounds_interior)
            state.interior = at.beyond;
}

template <KernelFeatures F>
Rgb PathSample<F>::transmittance_beyond(const OrientedSurface &at, const Ray &ray, float distance) {
    const Medium *medium = F.medium ? at.beyond.medium(scene().outside()) : nullptr;
    return medium ? transmittance(*medium, ray, distance) : Rgb(1);
}

template <KernelFeatures F>
bool PathSample<F>::passes_through(State &state, const Interaction &surface, const Shading &shading, float distance,
                                   bool certain) {
    if constexpr (F.transparency) {
        const float through = max_component(shading.transparency);
        if (!(through > 0))
            return false;
        const float scattered = certain ? 0 : max_component(albedo(shading.bsdf));
        const float share = through / (through + scattered);
        if (share < 1 && !sampler_.next_bool(share)) {
            state.beta *= 1 / (1 - share);
            return false;
        }
        state.beta *= shading.transparency * (1 / share);
        state.ray.origin = surface.origin_towards(state.ray.direction);
        state.passed += distance;
        return true;
    }
    return false;
}

template <KernelFeatures F>
void PathSample<F>::leave_specular(State &state, const Interaction &surface, const Vec3f &wi) {
    state.ray = {surface.origin_towards(wi), wi, state.ray.time};
    state.previous = {};
    state.passed = {};
    state.depth_since_first += state.seen_directly() ? 0 : 1;
    ++state.depth;
}

template <KernelFeatures F>
void PathSample<F>::leave_rough(State &state, const Interaction &surface, const Vec3f &geometric, const Vec3f &wi,
                                float pdf) {
    state.ray = {surface.origin_towards(wi), wi, state.ray.time};
    state.previous = {};
    state.passed = {};
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
    Bsdf bsdf = shading.bsdf;
    const auto oriented_surface = orient(state, surface, shading);
    if (is_specular(bsdf) || !oriented_surface)
        return;
    set_surface(bsdf, *oriented_surface);
    sample_lights_at(state, surface, bsdf, *oriented_surface, 1, Lobes::all);
    const auto s = sample(bsdf, oriented_surface->wo, sampler_.stratified_1d(dimension(Dimension::candidate_lobe)),
                          sampler_.stratified_2d(dimension(Dimension::candidate_direction)));
    if (!s || s->specular)
        return;
    const Vec3f wi = normalize(oriented_surface->frame.to_world(s->wi));
    if (!is_on_side(*s, wi, oriented_surface->geometric))
        return;
    State next = state;
    next.emission_mode = EmissionMode::only;
    next.beta *= s->weight;
    next.ray_flags = ray_flags(*s);
    if constexpr (F.passes)
        set_shares(next, state, bsdf, oriented_surface->wo, *s, scene());
    if (s->transmitted)
        cross_boundary(next, *oriented_surface);
    set_kind(next, kind_of(*s));
    leave_rough(next, surface, oriented_surface->geometric, wi, s->pdf);
    if (may_meet_light(next.ray))
        push(next);
}

template <KernelFeatures F>
Vec3f PathSample<F>::start_on_curve(const ShadowTerminator &terminator, const Interaction &surface,
                                    const Vec3f &geometric, LightSample &light) {
    const Vec3f offset = terminator.offset(light.direction);
    const bool beneath = !(dot(light.direction, geometric) > 0);
    const Vec3f origin =
        (beneath ? surface.origin_towards(geometric) : surface.origin_towards(light.direction)) + offset;
    if (light.distance < kInfinity && length_squared(offset) > 0) { // the same point of the light
        const Vec3f way = light.direction * light.distance - offset;
        light.distance = length(way);
        light.direction = way / light.distance;
    }
    return origin;
}

template <KernelFeatures F>
void PathSample<F>::sample_lights_at(const State &state, const Interaction &surface, const Bsdf &bsdf,
                                     const OrientedSurface &oriented_surface, uint32_t branches, Lobes lobes) {
    const Frame &frame = oriented_surface.frame;
    const Vec3f &geometric = oriented_surface.geometric, &wo = oriented_surface.wo;
    if (scene().lights.size() == 0)
        return;
    const bool camera = state.is_camera_segment(), several = state.seen_directly();
    const bool both_sides = F.transmission && transmits(bsdf);
    const Medium *medium = medium_of(state);
    const Vec3f x = light_sampling_origin(surface, geometric);
    const ShadowTerminator terminator =
        F.terminators && scene().has_shadow_terminators
            ? ShadowTerminator(*scene().accel, surface, geometric, frame.z, state.ray.time)
            : ShadowTerminator();
    struct Candidate {
        LightSample light;
        Rgb value; ///< what it brings unless it is hidden
        float part;
        [[no_unique_address]] std::conditional_t<F.passes, PassState, Absent<5>> shares{};
    };
    std::array<Candidate, tuning::kMaxLightsSampledEach> candidates;
    uint32_t count = 0;
    const bool few_rays = (!several || (camera && context_.plan.pixel_ris)) && every_light(true);
    for (uint32_t i = 0; i < choices(several || few_rays); ++i) {
        const LightChoice choice = choose(i, several || few_rays, x);
        const auto light =
            sample_light(choice.index, x,
                         camera ? sampler_.stratified_2d(dimension(Dimension::surface_light, i)) : sampler_.next_2d());
        if (!light || is_beyond_bounces(choice.index, state.depth))
            continue;
        const Vec3f wi = frame.to_local(light->direction);
        const float side = dot(light->direction, geometric);
        const bool beyond = both_sides && side < 0;
        const bool above = F.terminators && terminator ? terminator.faces(light->direction) : side > 0;
        const bool beneath = above && !(side > 0); // the triangle's horizon
        if (beyond ? !(wi.z < 0) : !above || !(wi.z > 0))
            continue;
        const Rgb f_cos = eval_for(*light, bsdf, wo, wi);
        Rgb value = f_cos * light->radiance * (1 / light->pdf / choice.probability);
        const Ray to_light{x, light->direction, state.ray.time};
        if (F.transmission && beyond && oriented_surface.bounds_interior)
            value *= transmittance_beyond(oriented_surface, to_light, light->distance);
        else if (medium)
            value *= transmittance(*medium, to_light, light->distance);
        if (lobes != Lobes::all)
            value *= fraction_of(lobes, vertex_fraction(oriented_surface, f_cos, wi));
        if (!light->delta && !is_black(value))
            value *= uses_cycles_weights() || beneath // where no BSDF sample is taken
                         ? cycles_weight(light->pdf / float(scene().lights.size()), pdf(bsdf, wo, wi))
                         : balance(choice.probability * light->pdf, float(branches) * pdf(bsdf, wo, wi));
        if (is_black(value))
            continue;
        candidates[count] = {*light, value, std::abs(value.r) + std::abs(value.g) + std::abs(value.b)};
        if constexpr (F.passes) {
            candidates[count].light.group = group_of(choice.index, *light);
            if (state.depth == 0)
                candidates[count].shares = shares_of(bsdf, wo, wi, light->visible);
        }
        ++count;
    }
    float parts = 0;
    for (uint32_t i = 0; i < count; ++i)
        parts += candidates[i].part;
    for (uint32_t i = 0; i < count; ++i) {
        Candidate &c = candidates[i];
        // Beyond the first surface, each light gets its shadow ray with a probability by its part of the sum.
        const float tested = few_rays ? std::min(tuning::kShadowRaysBeyondFirstSurface * c.part / parts, 1.0f) : 1.0f;
        if (tested < 1 && !sampler_.next_bool(tested))
            continue;
        Vec3f origin = surface.origin_towards(c.light.direction);
        if constexpr (F.terminators)
            if (terminator)
                origin = start_on_curve(terminator, surface, geometric, c.light);
        const Rgb arriving = c.value * visibility(origin, c.light, state.ray.time, surface.error);
        if (is_black(arriving))
            continue;
        if constexpr (F.passes)
            add_scattered(state, PathClass::surface, state.beta * arriving * (1 / tested), c.light.group, &c.shares);
        else
            add_scattered(state, PathClass::surface, state.beta * arriving * (1 / tested), 0);
    }
}

} // namespace glimmer
