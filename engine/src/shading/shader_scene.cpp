// SPDX-License-Identifier: GPL-3.0-or-later
#include "shading/shader_scene.h"

#include "base/error.h"
#include "shading/material_schema.h"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace glimmer {

namespace {

size_t leaves(std::span<const MaterialDescription> nodes, uint32_t index) {
    const MaterialDescription &m = nodes[index];
    if (!has_parts(m))
        return m.type == MaterialType::subsurface ? 2 : 1;
    return std::min(leaves(nodes, m.a) + leaves(nodes, m.b), ClosureArena::kMaxClosures + 1);
}

bool gives(std::span<const ParameterBinding> bindings, std::string_view key) {
    return std::ranges::any_of(
        bindings, [key](const ParameterBinding &b) { return !b.is_normal() && key == kParameters[b.row].info.key; });
}

/// The programs of a material and its parts, and whether any of them may shine.
void collect(const ShaderScene &scene, uint32_t index, VaryingMaterial &out) {
    const MaterialDescription &m = scene.nodes[index];
    const std::span<const ParameterBinding> bindings = scene.bindings[index];
    for (const ParameterBinding &b : bindings)
        if (std::ranges::find(out.programs, b.program) == out.programs.end())
            out.programs.push_back(b.program);
    out.shines |= may_shine(m, bindings);
    if (has_parts(m)) {
        collect(scene, m.a, out);
        collect(scene, m.b, out);
    }
}

/// Two unit tangents, as Blender chooses them.
void tangents_of(const Vec3f &n, Vec3f &x, Vec3f &y) {
    x = n.x != n.y || n.x != n.z ? Vec3f(n.z - n.y, n.x - n.z, n.y - n.x) : Vec3f(n.z - n.y, n.x + n.z, -n.y - n.x);
    x = normalize(x);
    y = cross(n, x);
}

/// A shading normal keeps to its side of the surface.
Vec3f above(const Vec3f &normal, const Vec3f &geometric) {
    constexpr float kLeast = 1e-3f;
    const float size = length(normal);
    if (!(size > 0) || !std::isfinite(size))
        return geometric;
    const Vec3f n = normal / size;
    const float cosine = dot(n, geometric);
    return cosine >= kLeast ? n : normalize(n + geometric * (kLeast - cosine));
}

} // namespace

bool may_shine(const MaterialDescription &node, std::span<const ParameterBinding> bindings) {
    return !is_black(node.emission) || !is_black(node.radiance) || gives(bindings, "emission") ||
           gives(bindings, "radiance");
}

void set_axes(ObjectFrame &frame, const Linear &linear) {
    for (size_t r = 0; r < 3; ++r)
        frame.to_world[r] = Vec3f(linear.rows[r]);
    const Linear cofactor = linear.cofactor();
    const double determinant = linear.determinant();
    const std::array<Vec3d, 3> &c = cofactor.rows; // the inverse is their transpose over the determinant
    frame.to_object = {Vec3f(Vec3d(c[0].x, c[1].x, c[2].x) / determinant),
                       Vec3f(Vec3d(c[0].y, c[1].y, c[2].y) / determinant),
                       Vec3f(Vec3d(c[0].z, c[1].z, c[2].z) / determinant)};
}

ObjectFrame frame_of(const Instance &instance, const Vec3d &origin, ObjectFrame frame) {
    Linear linear;
    for (size_t r = 0; r < 3; ++r)
        linear.rows[r] = Vec3d(instance.linear[r]);
    set_axes(frame, linear);
    const Vec3d &m = instance.mesh->center;
    frame.location = Vec3f(Vec3d(instance.translation) + origin -
                           Vec3d(dot(linear.rows[0], m), dot(linear.rows[1], m), dot(linear.rows[2], m)));
    frame.index = float(instance.object_index);
    return frame;
}

void ShaderScene::add(uint32_t material) {
    VaryingMaterial out;
    out.root = material;
    if (leaves(nodes, material) > ClosureArena::kMaxClosures)
        fail_argument("material \"" + nodes[material].label + "\" varies and has more than " +
                      std::to_string(ClosureArena::kMaxClosures) + " parts");
    collect(*this, material, out);
    out.first_value.assign(programs.size(), 0);
    for (uint32_t p : out.programs) {
        out.first_value[p] = out.value_count;
        out.value_count += uint32_t(programs[p]->output_count());
    }
    for (const ParameterBinding &b : bindings[material])
        if (b.is_normal())
            out.normal = b;
    varying_of[material] = uint32_t(materials.size());
    materials.push_back(std::move(out));
}

/// How far apart the rays of neighbouring pixels are at a place: the mean of both axes, across the ray.
float ShaderScene::pixel_at(const Vec3f &from_camera) const {
    const float depth = std::abs(dot(camera.to_camera[2], from_camera));
    const float x = dot(camera.to_camera[0], from_camera), y = dot(camera.to_camera[1], from_camera);
    const float away = length(from_camera);
    if (camera.orthographic)
        return pixel_width;
    if (camera.panorama) {
        if (!(away > 0))
            return 0;
        const Vec3f seen{x, y, dot(camera.to_camera[2], from_camera)};
        return away * pixel_width *
               std::sqrt(camera.panorama->solid_angle(camera.in_panorama(seen) / away) / camera.aspect);
    }
    return away > 0 ? pixel_width * 0.5f * (std::hypot(depth, x) + std::hypot(depth, y)) / away * depth : 0;
}

void ShaderScene::set_place(Place &place, const Interaction &surface, const View &view) const {
    ShaderGlobals &g = place.globals;
    const ShadingPoint point(*geometry, origin, surface, view);
    g.position = Vec3f(Vec3d(surface.position) + origin);
    g.backfacing = point.is_backfacing();
    g.normal = g.backfacing ? -surface.shading_normal : surface.shading_normal;
    g.true_normal = g.backfacing ? -surface.geometric_normal : surface.geometric_normal;
    g.incoming = view.wo;
    g.arrival = view.arrival;
    g.camera = &camera;
    g.u = surface.u;
    g.v = surface.v;
    const Vec3f from_camera = Vec3f(Vec3d(surface.position) + origin - Vec3d(camera.position));
    const float width = view.footprint > 0 ? view.footprint : pixel_at(from_camera);
    tangents_of(g.true_normal, g.dpdx, g.dpdy);
    g.dpdx = g.dpdx * width;
    g.dpdy = g.dpdy * width;
    if (point.is_sphere()) {
        const Sphere &sphere = point.sphere();
        const auto radius = float(sphere.radius);
        place.own.to_world = {Vec3f{radius, 0, 0}, {0, radius, 0}, {0, 0, radius}};
        place.own.to_object = {Vec3f{1 / radius, 0, 0}, {0, 1 / radius, 0}, {0, 0, 1 / radius}};
        place.own.location = Vec3f(sphere.center + origin);
        place.own.index = float(surface.object_index);
        g.object = &place.own;
        g.object_position = Vec3f(point.object_position());
        return;
    }
    const Mesh &mesh = point.mesh();
    g.object_position = Vec3f(point.object_position());
    g.object = &frames[surface.instance];
    if (point.is_moving()) {
        place.own = frame_of(point.instance(), origin, frames[surface.instance]);
        g.object = &place.own;
    }
    g.triangle = surface.primitive;
    g.vertices = &mesh.triangles[surface.primitive];
    g.vertex_positions = mesh.vertices.data();
    g.instance = instance_numbers[surface.instance];
    g.vertex_normals = mesh.normals.empty() ? nullptr : mesh.normals.data();
    if (const uint32_t object = geometry->instances()[surface.instance].object; object < attributes.size())
        g.attributes = attributes[object];
    const Vec3f &a = mesh.vertices[(*g.vertices)[0]];
    const Vec3f e1 = mesh.vertices[(*g.vertices)[1]] - a, e2 = mesh.vertices[(*g.vertices)[2]] - a;
    const Vec3f n = cross(e1, e2);
    const float n2 = length_squared(n);
    if (!(n2 > 0))
        return;
    const Vec3f along_u = cross(e2, n) / n2, along_v = cross(n, e1) / n2;
    const auto change = [&](const Vec3f &world) {
        const std::array<Vec3f, 3> &m = g.object->to_object;
        const Vec3f d{dot(m[0], world), dot(m[1], world), dot(m[2], world)};
        return Vec2f{dot(along_u, d), dot(along_v, d)};
    };
    g.dudx = change(g.dpdx);
    g.dudy = change(g.dpdy);
}

std::span<const Vec3f> ShaderScene::evaluate(const VaryingMaterial &material, const Interaction &surface,
                                             const View &view) const {
    static thread_local std::vector<Vec3f> values;
    Place place;
    set_place(place, surface, view);
    values.resize(material.value_count);
    for (uint32_t p : material.programs)
        programs[p]->evaluate(place.globals, values.data() + material.first_value[p]);
    return values;
}

Shading ShaderScene::shade(uint32_t varying, Interaction &surface, const View &view, ClosureArena &arena) const {
    static thread_local FlatMaterial flat;
    const VaryingMaterial &material = materials[varying];
    const ProgramOutputs outputs{evaluate(material, surface, view), material.first_value, bindings};
    flatten(nodes, material.root, &outputs, flat);
    if (material.normal) {
        const bool back = dot(view.wo, surface.geometric_normal) < 0;
        surface.softening = material.normal->softening();
        surface.smooth_normal = surface.shading_normal;
        surface.shading_normal = above(outputs(*material.normal) * (back ? -1.0f : 1.0f), surface.geometric_normal);
    }
    const std::span<WeightedLobe> room = arena.take(flat.lobes.size());
    std::copy(flat.lobes.begin(), flat.lobes.end(), room.begin());
    for (WeightedLobe &l : room)
        if (auto *metal = std::get_if<Brushed>(&l.lobe)) {
            const float side = dot(view.wo, surface.geometric_normal) < 0 ? -1.0f : 1.0f;
            set_frame(*metal, Frame(surface.shading_normal * side));
        }
    set_probabilities(room);
    return {Bsdf(room), flat.emission, flat.transparency, interior_ior(room), flat.holdout};
}

void ShaderScene::write_aovs(uint32_t material, const Interaction &surface, const View &view,
                             std::span<AovValue> out) const {
    Place place;
    set_place(place, surface, view);
    place.globals.material_index = float(material + 1);
    std::vector<Vec3f> values;
    uint32_t known = kNone; // the program whose values these are
    for (const ParameterBinding &b : aovs[material]) {
        if (b.program != known) {
            values.resize(programs[b.program]->output_count());
            programs[b.program]->evaluate(place.globals, values.data());
            known = b.program;
        }
        const Vec3f &v = values[b.output];
        AovValue &sum = out[b.row];
        sum.color += Rgb(v.x, v.y, v.z);
        sum.part += 1;
    }
}

Rgb ShaderScene::emission(uint32_t varying, const Interaction &surface, const View &view) const {
    static thread_local FlatMaterial flat;
    const VaryingMaterial &material = materials[varying];
    const ProgramOutputs outputs{evaluate(material, surface, view), material.first_value, bindings};
    flatten(nodes, material.root, &outputs, flat);
    return flat.emission;
}

Interaction ShaderScene::on_triangle(uint32_t instance, uint32_t primitive, Vec2f uv) const {
    const Instance &i = geometry->instances()[instance];
    const Mesh &mesh = *i.mesh;
    const auto &t = mesh.triangles[primitive];
    const Vec3f &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    Interaction at{};
    at.position = i.to_world(a * (1 - uv.x - uv.y) + b * uv.x + c * uv.y);
    const Vec3f e1 = b - a, e2 = c - a;
    const float scale = 1 / std::max(max_abs(e1), max_abs(e2));
    at.geometric_normal = normalize(i.normal_to_world(normalize(cross(e1 * scale, e2 * scale))));
    at.shading_normal = at.geometric_normal;
    if (!mesh.normals.empty()) {
        const Vec3f n = i.normal_to_world(mesh.normals[t[0]] * (1 - uv.x - uv.y) + mesh.normals[t[1]] * uv.x +
                                          mesh.normals[t[2]] * uv.y);
        if (length_squared(n) > 0)
            at.shading_normal = dot(n, at.geometric_normal) < 0 ? -normalize(n) : normalize(n);
    }
    at.material = object_materials[i.object][mesh.slot(primitive)];
    at.object_index = i.object_index;
    at.body = at.instance = instance;
    at.primitive = primitive;
    at.u = uv.x;
    at.v = uv.y;
    return at;
}

Rgb ShaderScene::of_triangle(uint32_t instance, uint32_t primitive, Vec2f uv, const Vec3f &wo) const {
    const Interaction at = on_triangle(instance, primitive, uv);
    return emission(varying_of[at.material], at, {.wo = wo, .arrival = kFromDiffuse});
}

Rgb ShaderScene::of_sphere(uint32_t sphere, const Vec3f &normal, const Vec3f &wo) const {
    const Sphere &s = geometry->spheres()[sphere];
    Interaction at{};
    at.position = Vec3f(s.center + Vec3d(normal) * s.radius);
    at.geometric_normal = at.shading_normal = normal;
    at.material = sphere_materials[sphere];
    at.body = uint32_t(geometry->instances().size()) + sphere;
    at.primitive = sphere;
    return emission(varying_of[at.material], at, {.wo = wo, .arrival = kFromDiffuse});
}

Rgb ShaderScene::light_of(const ParameterBinding &output, const ShaderGlobals &globals) const {
    static thread_local std::vector<Vec3f> values;
    values.resize(programs[output.program]->output_count());
    programs[output.program]->evaluate(globals, values.data());
    const Vec3f &v = values[output.output];
    const auto light = [](float x) { return x > 0 ? std::min(x, kMostOfPrograms) : 0.0f; };
    return {light(v.x), light(v.y), light(v.z)};
}

Rgb ShaderScene::of_sky(const Vec3f &direction, uint8_t ray, bool sun_disc) const {
    ShaderGlobals g;
    g.position = g.object_position = direction;
    g.normal = g.true_normal = g.incoming = -direction;
    g.camera = &camera;
    g.arrival = {ray, ray & kCameraRay ? 0.0f : 1.0f, 0};
    g.sun_disc = sun_disc;
    return light_of(*sky, g);
}

Rgb ShaderScene::of_lamp(uint32_t profile, const LampPlace &place) const {
    const LampProfile &lamp = lamps[profile];
    ShaderGlobals g;
    g.position = Vec3f(Vec3d(place.position) + origin);
    const Vec3f from_location = g.position - lamp.frame.location;
    const auto &[x, y, z] = lamp.frame.to_object;
    g.object_position = {dot(x, from_location), dot(y, from_location), dot(z, from_location)};
    g.normal = g.true_normal = place.normal;
    g.incoming = place.wo;
    g.object = &lamp.frame;
    g.camera = &camera;
    g.arrival = {0, 1, place.distance}; // by no kind of ray, as in Cycles
    return light_of(lamp.output, g);
}

float ShaderScene::mean_of_lamp(uint32_t profile) const {
    constexpr int kSide = 8;
    float sum = 0;
    for (int i = 0; i < kSide; ++i)
        for (int j = 0; j < kSide; ++j) {
            const Vec3f wo = sample_uniform_sphere({(float(i) + 0.5f) / kSide, (float(j) + 0.5f) / kSide});
            const Vec3f position(Vec3d(lamps[profile].frame.location) - origin);
            sum += mean_component(of_lamp(profile, {position, wo, wo, 1}));
        }
    return sum / (kSide * kSide);
}

Rgb ShaderScene::mean_of_triangle(uint32_t instance, uint32_t primitive, int side) const {
    Rgb sum;
    for (int i = 0; i < side; ++i)
        for (int j = 0; i + j < side; ++j) {
            const Vec2f uv{(float(i) + 1.0f / 3) / float(side), (float(j) + 1.0f / 3) / float(side)};
            const Interaction at = on_triangle(instance, primitive, uv);
            sum += emission(varying_of[at.material], at, {.wo = at.geometric_normal, .arrival = kFromDiffuse});
        }
    return sum * (2.0f / float(side * (side + 1)));
}

Rgb ShaderScene::mean_of_sphere(uint32_t sphere) const {
    constexpr int kRows = 8, kColumns = 16;
    Rgb sum;
    for (int i = 0; i < kRows; ++i)
        for (int j = 0; j < kColumns; ++j) {
            const float z = 2 * (float(i) + 0.5f) / kRows - 1, phi = 2 * kPi * float(j) / kColumns;
            const float r = std::sqrt(1 - z * z);
            const Vec3f n{r * std::cos(phi), r * std::sin(phi), z};
            sum += of_sphere(sphere, n, n);
        }
    return sum * (1.0f / (kRows * kColumns));
}

} // namespace glimmer
