// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrays.h"
#include "mesh_data.h"
#include "parts.h"
#include "text.h"

#include <algorithm>
#include <filesystem>

namespace glimmer {
namespace {

MeshData read_mesh_file(const Value &value, SceneFolder &folder) {
    const auto file = folder.read(value);
    const std::string name = value.where() + ": " + in_quotes(file.name);
    std::string extension = std::filesystem::path(file.name).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    MeshData mesh;
    if (extension == ".ply")
        mesh = parse_ply(file.bytes, name);
    else if (extension == ".obj")
        mesh = parse_obj(file.bytes, name);
    else
        value.fail(in_quotes(file.name) + " is not a mesh file; .ply and .obj are allowed");
    check_mesh(mesh, name);
    return mesh;
}

MeshData read_mesh_arrays(const Value &value, SceneFolder &folder) {
    MeshData mesh;
    mesh.vertices = read_float_array(value.at("vertices"), 3, folder);
    const auto check_length = [&](const char *key, size_t rows) {
        if (rows != mesh.vertex_count())
            value.at(key).fail("has " + std::to_string(rows) + " rows; one for each of the " +
                               std::to_string(mesh.vertex_count()) + " vertices is allowed");
    };
    if (const auto normals = value.find("normals")) {
        mesh.normals = read_float_array(*normals, 3, folder);
        check_length("normals", mesh.normals.size() / 3);
    }
    if (const auto uvs = value.find("uvs")) {
        mesh.uvs = read_float_array(*uvs, 2, folder);
        check_length("uvs", mesh.uvs.size() / 2);
    }
    const Value triangles = value.at("triangles");
    if (mesh.vertices.empty())
        value.at("vertices").fail("the list is empty; 3 or more vertices are allowed");
    mesh.triangles = read_index_array(triangles, 3, static_cast<uint32_t>(mesh.vertex_count() - 1), folder);
    check_mesh(mesh, value.where());
    return mesh;
}

Mesh read_mesh(const std::string &name, const Value &value, SceneFolder &folder) {
    value.expect_object({"file", "vertices", "triangles", "normals", "uvs", "slots", "attributes"});
    const bool has_arrays = value.has("vertices") || value.has("triangles") || value.has("normals") || value.has("uvs");
    if (value.has("file") == has_arrays)
        value.fail("needs either file, or vertices and triangles (and normals, uvs)");
    MeshData data = has_arrays ? read_mesh_arrays(value, folder) : read_mesh_file(value.at("file"), folder);
    Mesh mesh;
    if (const auto slots = value.find("slots")) {
        const auto numbers = read_index_array(*slots, 0, 65535, folder);
        if (numbers.size() != data.triangle_count())
            slots->fail("has " + std::to_string(numbers.size()) + " rows; one for each of the " +
                        std::to_string(data.triangle_count()) + " triangles is allowed");
        data.slots.assign(numbers.begin(), numbers.end());
        mesh.slot_count = size_t(1) + *std::max_element(numbers.begin(), numbers.end());
    }
    glimmer_mesh_desc desc;
    glimmer_mesh_init(&desc);
    desc.name = name.c_str();
    desc.format = GLIMMER_FLOAT64;
    desc.vertex_count = data.vertex_count();
    desc.vertices = data.vertices.data();
    desc.normals = data.normals.empty() ? nullptr : data.normals.data();
    desc.uvs = data.uvs.empty() ? nullptr : data.uvs.data();
    desc.triangle_count = data.triangle_count();
    desc.triangles = data.triangles.data();
    desc.slots = data.slots.empty() ? nullptr : data.slots.data();
    Attributes attributes;
    if (const auto table = value.find("attributes")) {
        const std::pair<std::string_view, size_t> rows_of[] = {
            {"vertex", data.vertex_count()}, {"corner", 3 * data.triangle_count()}, {"face", data.triangle_count()}};
        attributes = read_attributes(*table, rows_of, GLIMMER_PER_VERTEX, folder);
        desc.attribute_count = attributes.list.size();
        desc.attributes = attributes.list.data();
    }
    glimmer_mesh *handle = nullptr;
    check(glimmer_mesh_create(&desc, &handle), value.where());
    mesh.handle.reset(handle);
    return mesh;
}

} // namespace

Mesh &Meshes::find(const Value &name) {
    const auto found = entries.find(name.text());
    if (found == entries.end())
        refuse_name(name, "a mesh", "meshes", names);
    found->second.used = true;
    return found->second;
}

Meshes read_meshes(const Value &table, SceneFolder &folder) {
    Meshes meshes;
    table.for_each_named([&](const std::string &name, const Value &value) {
        meshes.names.push_back(name);
        meshes.entries.emplace(name, read_mesh(name, value, folder));
    });
    return meshes;
}

} // namespace glimmer
