// SPDX-License-Identifier: GPL-3.0-or-later
// A triangle mesh as the readers give it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace glimmer {

struct MeshData {
    std::vector<double> vertices;    ///< (n, 3), finite
    std::vector<double> normals;     ///< (n, 3) or empty
    std::vector<double> uvs;         ///< (n, 2) or empty
    std::vector<uint32_t> triangles; ///< (m, 3), each below n
    std::vector<uint16_t> slots;     ///< (m) or empty

    size_t vertex_count() const { return vertices.size() / 3; }
    size_t triangle_count() const { return triangles.size() / 3; }
};

/// Text or binary of either byte order. Reads element vertex (x y z; nx ny nz; s t, u v or texture_u texture_v) and
/// element face (vertex_indices or vertex_index); polygons become fans about their first vertex, other elements and
/// properties are skipped. Throws InputError "NAME: what".
MeshData parse_ply(std::string_view bytes, const std::string &name);

/// Wavefront: v, vn, vt and f; polygons are triangulated, material libraries and groups are ignored. A vertex used
/// with several normals or uvs becomes several. Throws InputError "NAME: what".
MeshData parse_obj(const std::string &text, const std::string &name);

/// Throws InputError "NAME: what" for a mesh that is empty or has a number that is not finite.
void check_mesh(const MeshData &mesh, const std::string &name);

} // namespace glimmer
