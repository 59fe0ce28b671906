// SPDX-License-Identifier: GPL-3.0-or-later
#include "errors.h"
#include "mesh_data.h"
#include "text.h"

#define TINYOBJLOADER_IMPLEMENTATION
#define TINYOBJLOADER_USE_DOUBLE
#include <algorithm>
#include <limits>
#include <map>
#include <sstream>
#include <string_view>
#include <tiny_obj_loader.h>
#include <tuple>

namespace glimmer {
namespace {

/// The line of the loader's warnings that has a word in it; "" when none has.
std::string line_with(const std::string &warnings, std::string_view word) {
    std::istringstream lines(warnings);
    for (std::string line; std::getline(lines, line);)
        if (line.find(word) != std::string::npos)
            return line;
    return "";
}

/// The lines that a mesh is made of. The loader stumbles over some others (skin weights and tags that are no numbers),
/// which no mesh of ours has a use for.
std::string mesh_lines(std::string_view text) {
    constexpr std::string_view words[] = {"v", "vn", "vt", "f"};
    std::string result;
    for (size_t end = 0; !text.empty(); text.remove_prefix(std::min(end + 1, text.size()))) {
        end = std::min(text.find_first_of("\r\n"), text.size());
        const std::string_view line = text.substr(0, end);
        const size_t start = std::min(line.find_first_not_of(" \t"), line.size());
        const std::string_view word = line.substr(start, line.find_first_of(" \t", start) - start);
        if (std::find(std::begin(words), std::end(words), word) != std::end(words))
            (result += line) += '\n';
        else
            result += '\n'; // the loader's messages count lines
    }
    return result;
}

} // namespace

MeshData parse_obj(const std::string &text, const std::string &name) {
    const auto fail = [&](const std::string &what) { throw InputError(name + ": " + what); };
    tinyobj::attrib_t attributes;
    std::vector<tinyobj::shape_t> shapes;
    std::vector<tinyobj::material_t> materials;
    std::string warnings, errors;
    std::istringstream stream(mesh_lines(text));
    if (!tinyobj::LoadObj(&attributes, &shapes, &materials, &warnings, &errors, &stream, nullptr, true))
        fail(errors.empty() ? "is not a .obj file" : one_line(errors));
    // The loader would leave such faces out.
    if (const std::string line = line_with(warnings, "out of bounds"); !line.empty())
        fail(one_line(line));

    // One vertex for each different (position, normal, uv); a normal or uv counts only where all corners have one.
    size_t corners = 0, with_normal = 0, with_uv = 0;
    for (const auto &shape : shapes) {
        for (const tinyobj::index_t &index : shape.mesh.indices) {
            ++corners;
            with_normal += index.normal_index >= 0;
            with_uv += index.texcoord_index >= 0;
        }
    }
    const bool has_normals = corners > 0 && with_normal == corners, has_uvs = corners > 0 && with_uv == corners;
    MeshData mesh;
    std::map<std::tuple<int, int, int>, uint32_t> known;
    const auto copy = [&](const std::vector<double> &from, int index, size_t width, std::vector<double> &to,
                          const char *what) {
        if (index < 0 || (static_cast<size_t>(index) + 1) * width > from.size())
            fail(std::string("a face uses ") + what + " " + std::to_string(index + 1) + "; there are " +
                 std::to_string(from.size() / width));
        const auto begin = from.begin() + static_cast<ptrdiff_t>(static_cast<size_t>(index) * width);
        to.insert(to.end(), begin, begin + static_cast<ptrdiff_t>(width));
    };
    for (const auto &shape : shapes) {
        for (const tinyobj::index_t &index : shape.mesh.indices) {
            const std::tuple key(index.vertex_index, has_normals ? index.normal_index : -1,
                                 has_uvs ? index.texcoord_index : -1);
            const auto [entry, is_new] = known.try_emplace(key, static_cast<uint32_t>(mesh.vertex_count()));
            if (is_new) {
                copy(attributes.vertices, index.vertex_index, 3, mesh.vertices, "vertex");
                if (has_normals)
                    copy(attributes.normals, index.normal_index, 3, mesh.normals, "normal");
                if (has_uvs)
                    copy(attributes.texcoords, index.texcoord_index, 2, mesh.uvs, "uv");
            }
            mesh.triangles.push_back(entry->second);
        }
    }
    return mesh;
}

} // namespace glimmer
