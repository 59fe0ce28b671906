// SPDX-License-Identifier: GPL-3.0-or-later
// What the passes of PassSample show of a sample: its light by the vertex that scattered it last before the camera, be
// that a mirror or glass, and what the camera sees there. Their sum is the sample's radiance.
#pragma once

#include "bsdf/lobe_sums.h"
#include "integrator/path/path_sample.h"
#include "sampling/warp.h"
#include "shading/shading_point.h"

#include <algorithm>
#include <cmath>

namespace glimmer {

template <KernelFeatures F>
void PathSample<F>::pass_light(const PassState &first, const Rgb &value, bool direct) {
    PassSample *out = trace_.passes;
    if (!out)
        return;
    if (first.in_medium) {
        (direct ? out->volume_direct : out->volume_indirect) += value;
        return;
    }
    const Rgb diffuse = value * first.diffuse, glossy = value * first.glossy;
    (direct ? out->diffuse_direct : out->diffuse_indirect) += diffuse;
    (direct ? out->glossy_direct : out->glossy_indirect) += glossy;
    (direct ? out->transmission_direct : out->transmission_indirect) += value - diffuse - glossy;
}

template <KernelFeatures F>
void PathSample<F>::pass_met(const State &state, const Rgb &value, uint8_t group, bool is_environment) {
    if (trace_.passes && group)
        trace_.passes->light_groups[group - 1] += value;
    // Through glass that counts as clear, the environment is seen as if there were none.
    const bool seen = state.depth == 0 || (is_environment && leaves_empty(state));
    if (!seen)
        return pass_light(state.passes, value, state.depth == 1);
    if (trace_.passes)
        (is_environment ? trace_.passes->environment : trace_.passes->emit) += value;
}

template <KernelFeatures F>
void PathSample<F>::pass_scattered(const State &state, PathClass vertex, const Rgb &value, uint8_t group,
                                   const PassState *shares) {
    if (trace_.passes && group)
        trace_.passes->light_groups[group - 1] += value;
    if (state.depth > 0)
        return pass_light(state.passes, value, false);
    PassState first = shares ? *shares : PassState();
    first.in_medium = vertex == PathClass::medium;
    pass_light(first, value, true);
}

template <KernelFeatures F>
PassState PathSample<F>::shares_of(const Bsdf &bsdf, const Vec3f &wo, const Vec3f &wi, RayMask visible) {
    const auto sees = [&](RayKind kind) { return (visible & mask_of(kind)) != 0; };
    const LobeSums f = eval_by_kind(bsdf, wo, wi, [&](const Lobe &lobe) {
        return sees(wi.z < 0 ? RayKind::transmission : is_diffuse(lobe) ? RayKind::diffuse : RayKind::glossy);
    });
    PassState shares;
    for (int c = 0; c < 3; ++c)
        if (const float sum = f.diffuse[c] + f.glossy[c] + f.transmission[c]; sum > 0) {
            shares.diffuse[c] = f.diffuse[c] / sum;
            shares.glossy[c] = f.glossy[c] / sum;
        }
    return shares;
}

template <KernelFeatures F>
void PathSample<F>::set_shares(State &next, const State &state, const Bsdf &bsdf, const Vec3f &wo, const BsdfSample &s,
                               const Scene &scene) {
    const auto *glass = std::get_if<Dielectric>(&bsdf[s.lobe].lobe);
    next.passes.sees_environment &= s.transmitted && glass && glass->alpha <= scene.film.transparent_width;
    if (state.depth > 0)
        return;
    const bool sees_environment = next.passes.sees_environment;
    next.passes = s.specular ? PassState{{}, Rgb(s.transmitted ? 0.0f : 1.0f)} : shares_of(bsdf, wo, s.wi);
    next.passes.sees_environment = sees_environment;
}

template <KernelFeatures F>
void PathSample<F>::pass_first_surface(const Interaction &surface, ShutterTime time) {
    PassSample *out = trace_.passes;
    if (!out)
        return;
    out->position = Vec3f(Vec3d(surface.position) + scene().origin);
    const View view{surface.shading_normal, 0, time};
    const ShadingPoint point(*scene().accel, scene().origin, surface, view);
    if (point.is_sphere() || !point.mesh().uvs.empty() || !point.mesh().attributes.empty()) {
        const Vec2f uv = point.map_uv();
        out->uv = {uv.x, uv.y, 1};
    }
}

template <KernelFeatures F>
void PathSample<F>::pass_aovs(const State &state, const Interaction &surface, float distance) {
    const ShaderScene *shaders = scene().materials.shaders.get();
    if (trace_.passes && shaders && !shaders->aovs.empty())
        shaders->write_aovs(surface.material, surface,
                            {-state.ray.direction, 0, state.ray.time, arrival(state, distance)}, trace_.passes->aovs);
}

template <KernelFeatures F>
void PathSample<F>::pass_occlusion(const State &state, const Interaction &surface, const Shading &shading,
                                   const OrientedSurface &at) {
    Sampler numbers = sampler_; // a copy: the picture does not depend on its passes
    const Vec3f direction = normalize(at.frame.to_world(sample_cosine_hemisphere(numbers.next_2d())));
    if (!(dot(direction, at.geometric) > 0))
        return;
    const Ray ray{surface.origin_towards(direction), direction, state.ray.time, scene().film.occlusion_distance};
    Rgb clear = glimmer::visibility<F.bvh>(scene(), ray, RayKind::shadow, trace_);
    if (const Medium *medium = medium_of(state))
        clear *= transmittance(*medium, ray, ray.t_max);
    trace_.passes->ambient_occlusion += state.beta * (Rgb(1) - shading.transparency) * clear;
}

template <KernelFeatures F>
void PathSample<F>::pass_surface(const State &state, const Hit &hit, const Interaction &surface,
                                 const Shading &shading) {
    PassSample *out = trace_.passes;
    if (!out)
        return;
    const FilmSettings &film = scene().film;
    const float behind = scene().camera.distance(surface.position) - film.mist_start;
    const float mist = film.mist_depth > 0 ? std::clamp(behind / film.mist_depth, 0.0f, 1.0f)
                       : behind > 0        ? 1.0f
                                           : 0.0f;
    const float opaque = mean_component(state.beta * (Rgb(1) - shading.transparency));
    if (opaque > 0 && out->cover_count < out->covers.size())
        out->covers[out->cover_count++] = {scene().passes_of(hit).matte, surface.material + 1, opaque};
    out->clearness += (1 - std::pow(mist, film.mist_falloff)) * opaque;

    if (shading.holdout > 0 && state.passes.sees_environment)
        out->transparency += mean_component(state.beta) * shading.holdout;

    const auto oriented_surface = orient(state, surface, shading);
    if (!oriented_surface)
        return;
    if (context_.ambient_occlusion)
        pass_occlusion(state, surface, shading, *oriented_surface);
    Bsdf bsdf = shading.bsdf;
    bsdf.eta = oriented_surface->eta;
    const LobeSums color = albedo_by_kind(bsdf, oriented_surface->wo);
    out->diffuse_color += state.beta * color.diffuse;
    out->glossy_color += state.beta * color.glossy;
    out->transmission_color += state.beta * color.transmission;
}

template <KernelFeatures F>
void PathSample<F>::pass_empty(const State &state, float end, const Medium *medium) {
    if constexpr (F.passes)
        // A path that goes on for the light alone that it meets leaves this to the one that goes on for the rest.
        if (trace_.passes && state.passes.sees_environment && state.emission_mode != EmissionMode::only)
            trace_.passes->transparency +=
                mean_component(medium ? state.beta * transmittance(*medium, state.ray, end) : state.beta);
}

} // namespace glimmer
