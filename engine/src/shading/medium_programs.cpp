// SPDX-License-Identifier: GPL-3.0-or-later
#include "shading/medium_programs.h"

#include "shading/shader_scene.h"

#include <algorithm>
#include <cmath>

namespace glimmer {

namespace {

constexpr float kMostG = 0.999f;

float cut(float x) {
    return x > 0 ? std::min(x, kMostOfPrograms) : 0.0f; // NaN is none
}

/// Everything that a medium knows of its place: no surface is there.
void set_place(ShaderGlobals &g, const Vec3f &world, const ObjectFrame &frame, const Vec3d &local) {
    g.position = world;
    g.object = &frame;
    g.object_position = Vec3f(local);
    g.arrival = {kVolumeScatterRay, 1, 0};
}

} // namespace

bool MediumSources::gives(MediumKey key) const {
    return std::ranges::any_of(bindings, [key](const MediumBinding &b) { return b.key == key; });
}

MediumPoint MediumPrograms::at(uint32_t medium, uint32_t body, const Vec3f &x, ShutterTime time) const {
    const MediumSources &sources = media[medium];
    const MediumBody &own = bodies[body];
    ShaderGlobals globals;
    ObjectFrame moved;
    const ObjectFrame *frame = &own.frame;
    const std::optional<Instance> instance = boundaries->instance(body, own.moves ? time : ShutterTime());
    if (own.moves && instance) {
        moved = frame_of(*instance, origin, own.frame);
        frame = &moved;
    }
    const Vec3d from = instance ? Vec3d(instance->translation) : boundaries->sphere(body).center;
    const Vec3d way = Vec3d(x) - from, center = instance ? instance->mesh->center : Vec3d();
    const auto &rows = frame->to_object;
    const Vec3d local(dot(Vec3d(rows[0]), way), dot(Vec3d(rows[1]), way), dot(Vec3d(rows[2]), way));
    set_place(globals, Vec3f(Vec3d(x) + origin), *frame, local + center);
    globals.camera = &camera;
    globals.attributes = own.attributes;
    globals.instance = own.instance;

    MediumPoint out = sources.constants;
    thread_local std::vector<Vec3f> values;
    uint32_t evaluated = kNone;
    for (const MediumBinding &b : sources.bindings) { // of one program one after another
        if (b.program != evaluated) {
            values.resize(programs[b.program]->output_count());
            programs[b.program]->evaluate(globals, values.data());
            evaluated = b.program;
        }
        const Vec3f &v = values[b.output];
        const Rgb color{cut(v.x), cut(v.y), cut(v.z)};
        switch (b.key) {
        case MediumKey::sigma_a:
            out.sigma_a = color;
            break;
        case MediumKey::sigma_s:
            out.sigma_s = color;
            break;
        case MediumKey::emission:
            out.emission = color;
            break;
        case MediumKey::g:
            out.g = v.x > -kMostG ? std::min(v.x, kMostG) : v.x <= -kMostG ? -kMostG : 0;
            break;
        }
    }
    return out;
}

} // namespace glimmer
