// SPDX-License-Identifier: GPL-3.0-or-later
// Instances and spheres, relative to the camera, and the BVH over them.
#include "base/error.h"
#include "math/rounding.h"
#include "scene/builder.h"

#include <algorithm>
#include <cmath>

namespace glimmer {

namespace {

/// A triangle's own rows of an attribute; none of one of vertices.
void copy_triangle(const MeshAttribute &from, uint32_t triangle, MeshAttribute &to) {
    const size_t width = from.components, rows = from.domain == GLIMMER_PER_CORNER ? 3 : 1;
    if (from.domain == GLIMMER_PER_VERTEX)
        return;
    const auto first = from.values.begin() + ptrdiff_t(triangle * rows * width);
    to.values.insert(to.values.end(), first, first + ptrdiff_t(rows * width));
}

} // namespace

/// The object's mesh, or a copy of it without the triangles whose material is absent; null when none is left.
std::shared_ptr<const Mesh> SceneBuilder::without_absent(const ObjectDescription &object) const {
    const Mesh &mesh = *object.mesh;
    const auto null = [&](size_t slot) { return scene_.materials[object.materials[slot]].null; };
    size_t gone = 0;
    for (size_t s = 0; s < mesh.slot_count; ++s)
        gone += null(s);
    if (gone == 0)
        return object.mesh;
    if (gone == mesh.slot_count)
        return nullptr;
    auto rest = std::make_shared<Mesh>();
    rest->name = mesh.name;
    rest->center = mesh.center;
    rest->vertices = mesh.vertices;
    rest->normals = mesh.normals;
    rest->uvs = mesh.uvs;
    rest->radius = mesh.radius;
    rest->slot_count = mesh.slot_count;
    for (const MeshAttribute &a : mesh.attributes)
        rest->attributes.push_back({a.name, a.domain, a.components, {}});
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t)
        if (!null(mesh.slot(t))) {
            rest->triangles.push_back(mesh.triangles[t]);
            rest->slots.push_back(mesh.slot(t));
            for (size_t k = 0; k < mesh.attributes.size(); ++k)
                copy_triangle(mesh.attributes[k], t, rest->attributes[k]);
        }
    for (size_t k = 0; k < mesh.attributes.size(); ++k)
        if (mesh.attributes[k].domain == GLIMMER_PER_VERTEX)
            rest->attributes[k].values = mesh.attributes[k].values;
    return rest->triangles.empty() ? nullptr : rest;
}

bool SceneBuilder::may_shine_anywhere(const ObjectDescription &object) const {
    return std::ranges::any_of(object.materials, [&](uint32_t m) { return material_may_shine(m); });
}

std::optional<Instance> SceneBuilder::place(const ObjectDescription &object, size_t i, const Mesh &mesh,
                                            std::vector<InstanceMotion> &motions) {
    const Affine &a = object.instances[i];
    Instance instance{};
    instance.mesh = &mesh;
    if (!instance.place(a.linear, a * mesh.center - origin_))
        return std::nullopt;
    if (!object.moves())
        return instance;
    InstanceMotion motion;
    bool placed = true;
    for (const std::vector<Affine> &step : object.motion) {
        motion.push_back(instance);
        placed &= motion.back().place(step[i].linear, step[i] * mesh.center - origin_);
    }
    if (placed && is_solid(motion) && !may_shine_anywhere(object)) {
        instance.motion = uint32_t(motions.size());
        motions.push_back(std::move(motion));
        return instance;
    }
    return placed ? motion[motion.size() / 2] : instance;
}

void SceneBuilder::use(uint32_t index) {
    const Material &material = scene_.materials[index];
    used_[index] = true;
    scene_.has_dielectrics |= material.interior_ior > 0;
    scene_.has_transmission |= material.bounds.transmits;
    scene_.has_transparency |= material.bounds.transparent;
    scene_.has_subsurface |= material.bounds.subsurface;
    scene_.has_surfaces |= material.bounds.scatters;
    scene_.max_value = std::max(scene_.max_value, material.bounds.max_value);
}

bool SceneBuilder::material_may_shine(uint32_t material) const {
    const MaterialDescription &m = description_.materials[material];
    if (has_parts(m) && (material_may_shine(m.a) || material_may_shine(m.b)))
        return true;
    return may_shine(m, m.bindings);
}

void SceneBuilder::note_visibility(RayMask visible, bool holdout) {
    scene_.has_visibility |= visible != kEveryRay || holdout;
    scene_.techniques_differ |= !shades_as_it_is_met(visible);
    scene_.hides_beyond_camera |= !is_visible_beyond_camera(visible);
}

void SceneBuilder::build_geometry() {
    std::vector<Instance> instances;
    std::vector<InstanceMotion> motions;
    size_t flat = 0, folding = 0, shining = 0;
    for (const ObjectDescription &object : description_.objects) {
        add_boundaries(object);
        std::shared_ptr<const Mesh> mesh = without_absent(object);
        if (!mesh) {
            absent_objects_ += !object.interior;
            continue;
        }
        for (uint32_t material : object.materials)
            use(material);
        const bool shines = may_shine_anywhere(object);
        const auto index = uint32_t(scene_.object_materials.size());
        scene_.object_materials.push_back(object.materials);
        scene_.object_passes.push_back({object.matte, object.light_group});
        for (size_t i = 0; i < object.instances.size(); ++i) {
            auto instance = place(object, i, *mesh, motions);
            if (!instance) {
                ++flat; // no volume to enter and no inverse for the ray: as good as not there
                continue;
            }
            if (object.moves() && instance->motion == kNone)
                ++(shines ? shining : folding);
            instance->object = index;
            instance->visible = object.visible;
            instance->holdout = object.holdout;
            if (!mesh->normals.empty()) {
                instance->shadow_terminator = object.shadow_terminator;
                scene_.has_shadow_terminators |= object.shadow_terminator > 0;
            }
            instance->object_index =
                object.object_indices.size() > 1 ? object.object_indices[i] : object.object_indices[0];
            if (instance->motion != kNone)
                for (Instance &step : motions[instance->motion]) {
                    step.object = index, step.object_index = instance->object_index;
                    step.visible = object.visible, step.holdout = object.holdout;
                }
            instances.push_back(*instance);
            object_places_.push_back({size_t(&object - description_.objects.data()), i});
        }
        scene_.meshes_.push_back(std::move(mesh));
    }
    const auto warn = [&](size_t count, glimmer_warning_code code, const char *what) {
        if (count)
            scene_.warnings.push_back({code, std::to_string(count) + " instance(s) " + what});
    };
    warn(flat, GLIMMER_WARNING_FLAT_INSTANCE, "of zero scale, or nearly, were left out");
    warn(folding, GLIMMER_WARNING_FOLDING_MOTION,
         "turn too far between two steps of their motion and are held still; give more steps");
    warn(shining, GLIMMER_WARNING_SHINING_MOTION,
         "shine, so they are held still where they are in the middle of their motion");
    scene_.moves = !motions.empty() || scene_.camera.moves();

    std::vector<Sphere> spheres;
    std::vector<RayMask> visible;
    std::vector<bool> holdouts;
    for (const SpheresDescription &group : description_.spheres) {
        const Material &material = scene_.materials[group.material];
        add_boundaries(group);
        if (material.null) {
            absent_objects_ += !group.interior;
            continue;
        }
        use(group.material);
        for (size_t i = 0; i < group.centers.size(); ++i) {
            spheres.push_back({group.centers[i] - origin_, group.radii.size() == 1 ? group.radii[0] : group.radii[i]});
            scene_.sphere_materials.push_back(group.material);
            scene_.sphere_indices.push_back(group.object_index);
            scene_.sphere_passes.push_back({group.matte, group.light_group});
            visible.push_back(group.visible);
            holdouts.push_back(group.holdout);
        }
    }
    for (const Instance &instance : instances)
        note_visibility(instance.visible, instance.holdout);
    for (size_t i = 0; i < spheres.size(); ++i)
        note_visibility(visible[i], holdouts[i]);
    if (std::ranges::find(holdouts, true) != holdouts.end())
        scene_.sphere_holdouts = std::move(holdouts);
    if (std::ranges::all_of(visible, [](RayMask mask) { return mask == kEveryRay; }))
        visible.clear();
    scene_.accel = std::make_unique<Accel>(std::move(instances), std::move(motions), std::move(spheres),
                                           std::move(visible), threads_);
}

/// Whether the object is of glass and encloses no body by it.
bool SceneBuilder::is_sheet(const ObjectDescription &object, const Mesh &mesh) const {
    bool glass = false, passes_elsewhere = false;
    for (uint32_t m : object.materials) {
        const Material &material = scene_.materials[m];
        glass |= material.interior_ior > 0;
        passes_elsewhere |= !(material.interior_ior > 0) && (material.bounds.transmits || material.bounds.transparent);
    }
    return glass && (passes_elsewhere || !mesh.is_closed());
}

void SceneBuilder::find_sheets() {
    if (!scene_.has_dielectrics)
        return;
    const auto &instances = scene_.accel->instances();
    std::vector<bool> sheets;
    for (size_t i = 0; i < instances.size(); ++i) // those of one object stand in a row
        sheets.push_back(i > 0 && instances[i].object == instances[i - 1].object
                             ? sheets.back()
                             : is_sheet(description_.objects[object_places_[i].object], *instances[i].mesh));
    if (std::ranges::find(sheets, true) != sheets.end())
        scene_.sheets = std::move(sheets);
}

Interaction Scene::interaction(const Ray &ray, const Hit &hit) const {
    Interaction at;
    if (hit.instance == kNone) {
        const Sphere &sphere = accel->spheres()[hit.primitive];
        const Vec3d normal = normalize(Vec3d(ray.origin) + Vec3d(ray.direction) * double(hit.t) - sphere.center);
        at.position = Vec3f(sphere.center + normal * sphere.radius);
        at.geometric_normal = at.shading_normal = Vec3f(normal);
        at.error = kHitRounding * max_abs(at.position);
        at.material = sphere_materials[hit.primitive];
        at.object_index = sphere_indices[hit.primitive];
        at.body = uint32_t(accel->instances().size()) + hit.primitive;
        at.primitive = hit.primitive;
        return at;
    }
    const Instance &opening = accel->instances()[hit.instance];
    std::optional<Instance> moved;
    if (opening.motion != kNone)
        moved = interpolate(accel->motions()[opening.motion], ray.time);
    const Instance &instance = moved ? *moved : opening;
    const Mesh &mesh = *instance.mesh;
    const auto &triangle = mesh.triangles[hit.primitive];
    const Vec3f &a = mesh.vertices[triangle[0]], &b = mesh.vertices[triangle[1]], &c = mesh.vertices[triangle[2]];
    const float w = 1 - hit.u - hit.v;
    at.position = instance.to_world(a * w + b * hit.u + c * hit.v);
    // Edges are lengthened before the product, so that a triangle a micrometre wide keeps its normal.
    const Vec3f e1 = b - a, e2 = c - a;
    const float scale = 1 / std::max(max_abs(e1), max_abs(e2));
    at.geometric_normal = normalize(instance.normal_to_world(normalize(cross(e1 * scale, e2 * scale))));
    at.shading_normal = at.geometric_normal;
    if (!mesh.normals.empty()) {
        const Vec3f n = instance.normal_to_world(mesh.normals[triangle[0]] * w + mesh.normals[triangle[1]] * hit.u +
                                                 mesh.normals[triangle[2]] * hit.v);
        const float n_length = length(n);
        if (n_length > 0) {
            at.shading_normal = n / n_length;
            if (dot(at.shading_normal, at.geometric_normal) < 0)
                at.shading_normal = -at.shading_normal;
        }
    }
    const float local = std::max(max_abs(a), std::max(max_abs(b), max_abs(c)));
    const float stretch =
        std::max(max_abs(instance.linear[0]), std::max(max_abs(instance.linear[1]), max_abs(instance.linear[2])));
    at.error = kHitRounding * (max_abs(at.position) + stretch * local + max_abs(instance.translation));
    if (moved) // Embree interpolated the matrix in float32
        at.error *= 2;
    at.material = object_materials[instance.object][mesh.slot(hit.primitive)];
    at.object_index = instance.object_index;
    at.body = at.instance = hit.instance;
    at.primitive = hit.primitive;
    at.u = hit.u;
    at.v = hit.v;
    return at;
}

} // namespace glimmer
