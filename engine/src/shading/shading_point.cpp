// SPDX-License-Identifier: GPL-3.0-or-later
#include "shading/shading_point.h"

namespace glimmer {

Vec3d ShadingPoint::object_position() const {
    if (is_sphere())
        return (Vec3d(surface.position) - sphere().center) / sphere().radius;
    const auto &triangle = mesh().triangles[surface.primitive];
    const std::array<float, 3> w = weights();
    Vec3d sum = mesh().center;
    for (size_t k = 0; k < 3; ++k)
        sum += Vec3d(mesh().vertices[triangle[k]]) * double(w[k]);
    return sum;
}

Vec2f ShadingPoint::uv() const {
    if (is_sphere()) {
        const Vec3d p = object_position();
        return {float(std::atan2(p.y, p.x)) / (2 * kPi) + 0.5f,
                float(std::atan2(p.z, std::hypot(p.x, p.y))) / kPi + 0.5f};
    }
    if (mesh().uvs.empty())
        return {};
    const auto &triangle = mesh().triangles[surface.primitive];
    const std::array<float, 3> w = weights();
    Vec2f sum;
    for (size_t k = 0; k < 3; ++k) {
        sum.x += mesh().uvs[triangle[k]].x * w[k];
        sum.y += mesh().uvs[triangle[k]].y * w[k];
    }
    return sum;
}

Vec2f ShadingPoint::map_uv() const {
    if (is_sphere())
        return uv();
    for (const MeshAttribute &a : mesh().attributes)
        if (a.name == "uv" && a.domain == GLIMMER_PER_CORNER && a.components >= 2) {
            const std::array<float, 3> w = weights();
            Vec2f sum;
            for (size_t k = 0; k < 3; ++k) {
                const float *values = a.values.data() + (3 * size_t(surface.primitive) + k) * a.components;
                sum.x += values[0] * w[k];
                sum.y += values[1] * w[k];
            }
            return sum;
        }
    return uv();
}

Vec3f ShadingPoint::dpdu() const {
    if (is_sphere()) {
        const Vec3f n = surface.geometric_normal;
        const Vec3f east(-n.y, n.x, 0);
        return east * (2 * kPi * float(sphere().radius));
    }
    const Mesh &m = mesh();
    const auto &triangle = m.triangles[surface.primitive];
    const Vec3f e1 = m.vertices[triangle[1]] - m.vertices[triangle[0]],
                e2 = m.vertices[triangle[2]] - m.vertices[triangle[0]];
    Vec3f tangent = e1;
    if (!m.uvs.empty()) {
        const Vec2f &a = m.uvs[triangle[0]], &b = m.uvs[triangle[1]], &c = m.uvs[triangle[2]];
        const float determinant = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
        if (determinant != 0)
            tangent = (e1 * (c.y - a.y) - e2 * (b.y - a.y)) / determinant;
    }
    return instance().to_world(tangent) - instance().translation;
}

} // namespace glimmer
