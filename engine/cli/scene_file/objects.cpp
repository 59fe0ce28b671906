// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrays.h"
#include "parts.h"
#include "text.h"

#include <algorithm>

namespace glimmer {
namespace {

/// The instances' matrices as (n, 3, 4), flat.
std::vector<double> read_instances(const Value &value, SceneFolder &folder) {
    NpyArray array = read_float_npy(value, {{0, 3, 4}, {0, 4, 4}}, "(n, 3, 4) or (n, 4, 4)", folder);
    if (array.shape[1] == 3)
        return std::move(array.values);
    std::vector<double> result;
    result.reserve(array.shape[0] * 12);
    for (size_t i = 0; i < array.shape[0]; ++i) {
        const double *matrix = array.values.data() + 16 * i;
        if (matrix[12] != 0 || matrix[13] != 0 || matrix[14] != 0 || matrix[15] != 1)
            value.fail("the last row of matrix " + std::to_string(i) +
                       " is not 0 0 0 1 (column vectors: the translation is the last column)");
        result.insert(result.end(), matrix, matrix + 12);
    }
    return result;
}

std::vector<uint32_t> read_object_materials(const Value &object, const Materials &materials) {
    if (object.has("material") == object.has("materials"))
        object.fail("needs either material or materials");
    std::vector<uint32_t> result;
    if (const auto single = object.find("material"))
        result.push_back(materials.find(*single));
    else
        object.at("materials").for_each([&](const Value &name) { result.push_back(materials.find(name)); });
    return result;
}

} // namespace

uint32_t read_rays(const Value &list) {
    constexpr std::string_view names[] = {"camera", "diffuse", "glossy", "transmission", "volume", "shadow"};
    uint32_t set = 0;
    list.for_each([&](const Value &name) { set |= 1u << one_of(name, "a kind of rays", "kinds of rays", names); });
    return set;
}

Matrix matrix_or_identity(const Value &value, std::string_view key) {
    if (const auto matrix = value.find(key))
        return matrix->matrix();
    return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
}

std::vector<double> read_motion(const Value &value) {
    std::vector<double> motion;
    const auto steps = value.find("motion");
    if (!steps)
        return motion;
    steps->for_each([&](const Value &step) {
        const Matrix matrix = step.matrix();
        motion.insert(motion.end(), matrix.begin(), matrix.end());
    });
    if (motion.size() < 32)
        steps->fail("has fewer than 2 matrices: as the shutter opens, and as it closes");
    return motion;
}

void read_object(const Value &value, glimmer_scene *scene, const Programs &programs, const Materials &materials,
                 Meshes &meshes, SceneFolder &folder) {
    value.expect_object({"mesh", "material", "materials", "to_world", "motion", "instances", "index", "indices",
                         "color", "random", "randoms", "attributes", "visible", "holdout", "shadow_terminator",
                         "interior", "matte", "light_group"});
    const std::string name = value.path();
    glimmer_object_desc desc;
    glimmer_object_init(&desc);
    desc.name = name.c_str();
    Mesh &mesh = meshes.find(value.at("mesh"));
    desc.mesh = mesh.handle.get();

    const auto object_materials = read_object_materials(value, materials);
    if (object_materials.size() < mesh.slot_count)
        value.fail("the mesh " + in_quotes(value.at("mesh").text()) + " uses slot " +
                   std::to_string(mesh.slot_count - 1) + ", but there " +
                   (object_materials.size() == 1 ? "is 1 material"
                                                 : "are " + std::to_string(object_materials.size()) + " materials"));
    desc.material_count = object_materials.size();
    desc.materials = object_materials.data();

    const Matrix to_world = matrix_or_identity(value, "to_world");
    std::copy(to_world.begin(), to_world.end(), desc.to_world);
    if (value.has("motion") && value.has("to_world"))
        value.fail("needs either to_world or motion, which takes its place");
    const std::vector<double> motion = read_motion(value);
    if (!motion.empty()) {
        desc.motion = motion.data();
        desc.motion_count = motion.size() / 16;
    }
    const auto interior = read_interior(value, programs);
    read_body(value, interior, desc);

    std::vector<double> instances;
    std::vector<uint32_t> indices;
    if (const auto file = value.find("instances")) {
        instances = read_instances(*file, folder);
        desc.instance_count = instances.size() / 12;
        desc.instance_format = GLIMMER_FLOAT64;
        desc.instances = instances.data();
    }
    if (const auto file = value.find("indices")) {
        if (desc.instances == nullptr && !value.has("instances"))
            file->fail("indices are for objects with instances; a single one has index");
        indices = read_index_array(*file, 0, UINT32_MAX, folder);
        if (indices.size() != desc.instance_count)
            file->fail("has " + std::to_string(indices.size()) + " rows; one for each of the " +
                       std::to_string(desc.instance_count) + " instances is allowed");
        desc.object_indices = indices.data();
    }
    if (const auto color = value.find("color")) {
        const auto rgba = color->numbers<4>();
        std::copy(rgba.begin(), rgba.end(), desc.color);
    }
    if (const auto random = value.find("random"))
        desc.random = random->single(kUnit);
    if (const auto terminator = value.find("shadow_terminator"))
        desc.shadow_terminator = terminator->single(kUnit);
    const size_t count = desc.instances ? desc.instance_count : 1;
    std::vector<float> randoms;
    if (const auto file = value.find("randoms")) {
        const std::vector<double> numbers = read_float_array(*file, 0, folder);
        if (!value.has("instances") || numbers.size() != count)
            file->fail("has " + std::to_string(numbers.size()) + " rows; one for each instance is allowed");
        randoms.assign(numbers.begin(), numbers.end());
        desc.randoms = randoms.data();
    }
    Attributes attributes;
    if (const auto table = value.find("attributes")) {
        const std::pair<std::string_view, size_t> rows_of[] = {{"instance", count}};
        attributes = read_attributes(*table, rows_of, GLIMMER_PER_INSTANCE, folder);
        desc.attribute_count = attributes.list.size();
        desc.attributes = attributes.list.data();
    }
    if (value.has("instances") && desc.instance_count == 0)
        return; // an empty field is a field
    check(glimmer_scene_add_object(scene, &desc), value.where());
}

} // namespace glimmer
