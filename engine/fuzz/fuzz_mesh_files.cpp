// SPDX-License-Identifier: GPL-3.0-or-later
// Fuzzes the readers of .npy, .ply and .obj, whichever the first bytes name: a mesh or an InputError of one line.
#include "errors.h"
#include "fuzz.h"
#include "scene_file/mesh_data.h"
#include "scene_file/npy.h"

#include <string>
#include <string_view>

namespace glimmer {
namespace {

void read(std::string_view bytes) {
    const std::string name = "file";
    if (bytes.starts_with("\x93NUMPY")) {
        const NpyArray array = parse_npy(bytes, name);
        size_t count = 1;
        for (const size_t extent : array.shape)
            count *= extent;
        require(array.values.size() + array.integers.size() == count, "an array of another size than its shape");
        return;
    }
    const MeshData mesh = bytes.starts_with("ply") ? parse_ply(bytes, name) : parse_obj(std::string(bytes), name);
    check_mesh(mesh, name);
    for (const uint32_t vertex : mesh.triangles)
        require(vertex < mesh.vertex_count(), "a triangle of a vertex that is not there");
    require(mesh.normals.empty() || mesh.normals.size() == mesh.vertices.size(), "normals for some vertices");
    require(mesh.uvs.empty() || 3 * mesh.uvs.size() == 2 * mesh.vertices.size(), "uvs for some vertices");
}

} // namespace
} // namespace glimmer

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    try {
        glimmer::read({reinterpret_cast<const char *>(data), size});
    } catch (const glimmer::InputError &error) {
        glimmer::expect_one_line(error.what());
    }
    return 0;
}
