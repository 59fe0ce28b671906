// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh_data.h"

#include "errors.h"
#include "text.h"

#include <cmath>

namespace glimmer {

void check_mesh(const MeshData &mesh, const std::string &name) {
    if (mesh.vertex_count() < 3)
        throw InputError(name + ": has " + count_text(mesh.vertex_count(), "vertex", "vertices") +
                         "; 3 or more are allowed");
    if (mesh.triangle_count() == 0)
        throw InputError(name + ": has no triangles; 1 or more are allowed");
    const auto check_finite = [&](const std::vector<double> &values, size_t width, const char *what) {
        for (size_t i = 0; i < values.size(); ++i)
            if (!std::isfinite(values[i]))
                throw InputError(name + ": " + what + " " + std::to_string(i / width) + " is not finite");
    };
    check_finite(mesh.vertices, 3, "vertex");
    check_finite(mesh.normals, 3, "normal");
    check_finite(mesh.uvs, 2, "uv");
}

} // namespace glimmer
