// SPDX-License-Identifier: GPL-3.0-or-later
// Scattering at surfaces and glass.
#include "integrator/glass_crossing.h"
#include "integrator/mis.h"
#include "integrator/path_sample.h"

#include <cmath>

namespace glimmer {

void PathSample::note_first_surface(const Interaction &surface) {
    result_.hit = true;
    result_.normal = surface.shading_normal;
    result_.depth = dot(surface.position, scene_.camera.forward);
    result_.object_index = surface.object_index;
    result_.material_index = surface.material + 1;
}

void PathSample::scatter_at_surface(PathState &state, const Interaction &surface, bool rough) {
    const Material &material = scene_.materials[surface.material];
    if (material.kind == MaterialKind::glass)
        return pass_glass(state, surface, material);
    const Bsdf bsdf = scene_.bsdf(material);
    if (bsdf.empty() || !(rough || has_specular(bsdf)))
        return;
    const bool camera = state.depth == 0;
    const Vec3f wo = -state.ray.direction;
    // All materials but glass are two-sided: both normals turn to the viewer.
    const float side = dot(wo, surface.geometric_normal) < 0 ? -1.0f : 1.0f;
    const Vec3f geometric = surface.geometric_normal * side;
    Vec3f shading = surface.shading_normal * side;
    if (!(dot(wo, shading) > 1e-6f))
        shading = geometric;
    const Frame frame(shading);
    const Vec3f wo_local = frame.to_local(wo);
    if (!(wo_local.z > 0))
        return;
    if (state.direct_view())
        result_.albedo = albedo(bsdf);

    const bool all = state.direct_view();
    if (rough && !is_specular(bsdf))
        sample_lights_at(state, surface, bsdf, frame, geometric, wo_local, all);

    const auto s = sample(bsdf, wo_local, camera ? sampler_.stratified_1d(kSetLobe) : sampler_.next_1d(),
                          camera ? sampler_.stratified_2d(kSetBsdf) : sampler_.next_2d());
    if (!s || !(rough || s->specular))
        return;
    const Vec3f wi = normalize(frame.to_world(s->wi));
    if (!(dot(wi, geometric) > 0)) // below the true surface: a shading normal's promise that cannot be kept
        return;
    state.beta *= s->weight;
    if (!survives(state, surface.position) || (s->specular && !survives_chain(state)))
        return;
    state.ray = {surface.origin_towards(wi), wi};
    ++state.depth;
    if (s->specular) {
        state.origin = {};
        state.order += state.direct_view() ? 0 : 1;
    } else {
        state.origin = {};
        state.chain = 0;
        state.origin.kind = DirectionOrigin::Kind::surface;
        state.origin.all_lights = all;
        state.origin.pdf = s->pdf;
        state.origin.position = lit_point(surface, geometric);
        if (state.direct_view())
            state.first = PathState::First::surface;
        ++state.order;
    }
    push(state);
}

void PathSample::sample_lights_at(const PathState &state, const Interaction &surface, Bsdf bsdf, const Frame &frame,
                                  const Vec3f &geometric, const Vec3f &wo, bool all) {
    if (scene_.lights.size() == 0)
        return;
    const bool camera = state.depth == 0;
    const Homogeneous *fog = scene_.medium && state.glass.empty() ? &*scene_.medium : nullptr;
    const Vec3f x = lit_point(surface, geometric);
    for (uint32_t i = 0; i < choices(all); ++i) {
        const LightChoice choice = choose(i, all, x);
        const auto light = sample_light(scene_.lights[choice.index], x,
                                        camera ? sampler_.stratified_2d(kSetLight + i) : sampler_.next_2d());
        if (!light || !(dot(light->direction, geometric) > 0))
            continue;
        const Vec3f wi = frame.to_local(light->direction);
        if (!(wi.z > 0))
            continue;
        Rgb value = eval(bsdf, wo, wi) * light->radiance * (1 / light->pdf / choice.probability);
        if (fog)
            value *= fog->transmittance(light->distance);
        if (is_black(value) || occluded(surface.origin_towards(light->direction), *light, surface.error))
            continue;
        if (!light->delta)
            value *= balance(choice.probability * light->pdf, pdf(bsdf, wo, wi));
        value *= state.beta;
        switch (state.first) {
        case PathState::First::none:
            result_.direct += value;
            break;
        case PathState::First::surface:
            result_.indirect += value;
            break;
        case PathState::First::fog:
            result_.fog += value;
        }
    }
}

void PathSample::pass_glass(PathState &state, const Interaction &surface, const Material &material) {
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
