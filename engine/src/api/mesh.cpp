// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes and images.
#include "api/handles.h"

namespace glimmer {

std::vector<MeshAttribute> checked_attributes(size_t number, const glimmer_attribute *attributes,
                                              const std::array<size_t, 4> &rows_of_domain, const std::string &what) {
    if (number > Program::kMostResources || (number && !attributes))
        fail_argument(what + ": attributes are " + (attributes ? std::to_string(number) : "null") +
                      "; allowed: up to " + std::to_string(Program::kMostResources));
    std::vector<MeshAttribute> out;
    for (size_t i = 0; i < number; ++i) {
        const glimmer_attribute &a = attributes[i];
        const std::string which = what + ": attribute " + (a.name ? std::string(a.name) : std::to_string(i));
        if (!a.name || !a.values)
            fail_argument(which + (a.name ? ": values are null" : " has no name"));
        const auto domain = size_t(a.domain);
        if (domain >= rows_of_domain.size() || rows_of_domain[domain] == kNoRows)
            fail_argument(which + ": domain is " + std::to_string(int(a.domain)) +
                          "; allowed: " + (rows_of_domain[0] == kNoRows ? "3, an instance's" : "0 to 2, a mesh's"));
        check_range(a.components, 1, 4, which + ": components");
        for (const MeshAttribute &known : out)
            if (known.name == a.name)
                fail_argument(which + " is given twice");
        const size_t count = rows_of_domain[domain] * a.components;
        for (size_t k = 0; k < count; ++k)
            if (!std::isfinite(a.values[k]))
                fail_argument(which + ": row " + std::to_string(k / a.components) + " is not finite");
        out.push_back({a.name, a.domain, uint8_t(a.components), {a.values, a.values + count}});
    }
    return out;
}

namespace {

constexpr size_t kMostElements = 0xffffffffu; // indices are 32 bits

struct Array {
    const void *data;
    glimmer_format format;
    double operator[](size_t i) const {
        return format == GLIMMER_FLOAT64 ? static_cast<const double *>(data)[i]
                                         : double(static_cast<const float *>(data)[i]);
    }
};

void add_attributes(Mesh &mesh, const glimmer_mesh_desc &d, const std::string &what) {
    mesh.attributes = checked_attributes(d.attribute_count, d.attributes,
                                         {d.vertex_count, 3 * d.triangle_count, d.triangle_count, kNoRows}, what);
}

std::shared_ptr<Mesh> make_mesh(const glimmer_mesh_desc &d) {
    const std::string what = label_of("mesh", d.name);
    if (d.format != GLIMMER_FLOAT32 && d.format != GLIMMER_FLOAT64)
        fail_argument(what + ": format is " + std::to_string(int(d.format)) + "; allowed: float32 (0), float64 (1)");
    if (d.vertex_count < 3 || d.vertex_count >= kMostElements)
        fail_argument(what + ": vertex_count is " + std::to_string(d.vertex_count) + "; allowed: 3 to 4294967294");
    if (d.triangle_count < 1 || d.triangle_count >= kMostElements)
        fail_argument(what + ": triangle_count is " + std::to_string(d.triangle_count) + "; allowed: 1 to 4294967294");
    if (!d.vertices || !d.triangles)
        fail_argument(what + ": " + (d.vertices ? "triangles" : "vertices") + " is null");

    auto mesh = std::make_shared<Mesh>();
    mesh->name = d.name ? d.name : "";
    const Array vertices{d.vertices, d.format};
    Vec3d low(HUGE_VAL, HUGE_VAL, HUGE_VAL), high = -low;
    for (size_t i = 0; i < d.vertex_count; ++i) {
        const Vec3d v{vertices[3 * i], vertices[3 * i + 1], vertices[3 * i + 2]};
        if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z) || max_abs(v) > 1e30)
            fail_argument(what + ": vertex " + std::to_string(i) + " is (" + text(v.x) + ", " + text(v.y) + ", " +
                          text(v.z) + "); allowed: numbers up to 1e30");
        low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
        high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
    }
    mesh->center = (low + high) * 0.5;
    mesh->vertices.reserve(d.vertex_count + 1);
    for (size_t i = 0; i < d.vertex_count; ++i) {
        const Vec3d v = Vec3d{vertices[3 * i], vertices[3 * i + 1], vertices[3 * i + 2]} - mesh->center;
        mesh->vertices.push_back(Vec3f(v));
        mesh->radius = std::max(mesh->radius, max_abs(mesh->vertices.back()));
    }
    mesh->vertices.emplace_back();

    mesh->triangles.resize(d.triangle_count);
    for (size_t t = 0; t < d.triangle_count; ++t)
        for (size_t k = 0; k < 3; ++k) {
            const uint32_t index = d.triangles[3 * t + k];
            if (index >= d.vertex_count)
                fail_argument(what + ": triangle " + std::to_string(t) + " names vertex " + std::to_string(index) +
                              "; allowed: 0 to " + std::to_string(d.vertex_count - 1));
            mesh->triangles[t][k] = index;
        }
    if (d.normals) {
        const Array normals{d.normals, d.format};
        for (size_t i = 0; i < d.vertex_count; ++i) {
            const Vec3d n{normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]};
            const double size = length(n);
            if (!std::isfinite(size))
                fail_argument(what + ": normal " + std::to_string(i) + " is not finite");
            mesh->normals.push_back(size > 0 ? Vec3f(n / size) : Vec3f());
        }
    }
    if (d.uvs) {
        const Array uvs{d.uvs, d.format};
        for (size_t i = 0; i < d.vertex_count; ++i) {
            check_finite(uvs[2 * i], what + ": uv " + std::to_string(i));
            check_finite(uvs[2 * i + 1], what + ": uv " + std::to_string(i));
            mesh->uvs.push_back({float(uvs[2 * i]), float(uvs[2 * i + 1])});
        }
    }
    if (d.slots) {
        mesh->slots.assign(d.slots, d.slots + d.triangle_count);
        uint32_t most = 0;
        for (uint16_t s : mesh->slots)
            most = std::max<uint32_t>(most, s);
        if (most == 0xffff)
            fail_argument(what + ": slot 65535 is too large; allowed: 0 to 65534");
        mesh->slot_count = uint16_t(most + 1);
    }
    add_attributes(*mesh, d, what);
    return mesh;
}

} // namespace

} // namespace glimmer

using namespace glimmer;

extern "C" {

void glimmer_mesh_init(glimmer_mesh_desc *desc) {
    if (desc)
        *desc = {};
    if (desc)
        desc->struct_size = sizeof *desc;
}

glimmer_result glimmer_mesh_create(const glimmer_mesh_desc *desc, glimmer_mesh **mesh) {
    return guarded([&] {
        glimmer_mesh_desc defaults;
        glimmer_mesh_init(&defaults);
        const glimmer_mesh_desc d = checked_desc(desc, defaults, "mesh");
        if (!mesh)
            fail_argument("mesh: the output is null");
        auto handle = std::make_unique<glimmer_mesh>();
        handle->mesh = make_mesh(d);
        *mesh = handle.release();
    });
}

void glimmer_mesh_destroy(glimmer_mesh *mesh) {
    destroy(mesh);
}

glimmer_result glimmer_image_create(uint32_t width, uint32_t height, uint32_t channels, const float *pixels,
                                    glimmer_image **image) {
    return guarded([&] {
        if (!image)
            fail_argument("image: the output is null");
        if (!pixels)
            fail_argument("image: pixels is null");
        check_range(width, 1, 65536, "image: width");
        check_range(height, 1, 65536, "image: height");
        check_range(channels, 3, 4, "image: channels");
        auto handle = std::make_unique<glimmer_image>();
        handle->image = std::make_shared<Image>();
        handle->image->width = width;
        handle->image->height = height;
        const size_t count = size_t(width) * height;
        handle->image->pixels.reserve(count);
        for (size_t i = 0; i < count; ++i) {
            const float *p = pixels + i * channels;
            for (size_t c = 0; c < 3; ++c)
                if (!(p[c] >= 0 && p[c] < kInfinity))
                    fail_argument("image: the pixel at x " + std::to_string(i % width) + ", y " +
                                  std::to_string(i / width) + " holds " + text(double(p[c])) +
                                  "; allowed: finite numbers from 0");
            handle->image->pixels.push_back({p[0], p[1], p[2]});
        }
        *image = handle.release();
    });
}

void glimmer_image_destroy(glimmer_image *image) {
    destroy(image);
}
}
