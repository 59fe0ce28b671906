// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/shadow_terminator.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace glimmer {

namespace {

/// How high above a triangle the surface is that has these normals at its vertices: about a paraboloid, but no lower
/// than it takes to clear the planes at the vertices. Below it, negative, for light from beneath. b: barycentrics.
float height(const std::array<Vec3f, 3> &v, const std::array<Vec3f, 3> &n, const std::array<float, 3> &b, bool above) {
    const float p = dot(n[2] - n[0], v[0] - v[2]), q = dot(n[2] - n[1], v[1] - v[2]), r = dot(n[1] - n[0], v[1] - v[0]);
    const float paraboloid = p * b[0] * (b[0] - 1) + (p + q + r) * b[0] * b[1] + q * b[1] * (b[1] - 1);
    const Vec3f at = v[0] * b[0] + v[1] * b[1] + v[2] * b[2];
    const float side = above ? 1.0f : -1.0f;
    float clear = kInfinity;
    for (size_t i = 0; i < 3; ++i) {
        const Vec3f normal = n[i] * side;
        const float others = std::max(dot(v[(i + 1) % 3] - v[i], normal), dot(v[(i + 2) % 3] - v[i], normal));
        clear = std::min(clear, std::max(dot(v[i] - at, normal) + std::max(others, 0.0f), 0.0f));
    }
    return above ? std::max(clear, paraboloid / 2) : std::min(-clear, paraboloid / 2);
}

/// The normal without bumps.
Vec3f smooth_normal(const Interaction &surface, const Vec3f &geometric, const Vec3f &shading) {
    if (surface.softening == BumpSoftening::none)
        return shading;
    return surface.smooth_normal * std::copysign(1.0f, dot(geometric, surface.geometric_normal));
}

} // namespace

ShadowTerminator::ShadowTerminator(const Accel &geometry, const Interaction &surface, const Vec3f &geometric,
                                   const Vec3f &shading, ShutterTime time)
    : geometric_(geometric), smooth_(smooth_normal(surface, geometric, shading)) {
    if (surface.instance == kNone)
        return;
    const Instance &opening = geometry.instances()[surface.instance];
    if (!(opening.shadow_terminator > 0))
        return;
    const Mesh &mesh = *opening.mesh;
    const auto &corners = mesh.triangles[surface.primitive];
    std::array<Vec3f, 3> v, n;
    for (size_t i = 0; i < 3; ++i) {
        v[i] = mesh.vertices[corners[i]];
        n[i] = mesh.normals[corners[i]];
        if (!(length_squared(n[i]) > 0)) // flat
            return;
    }
    cosine_ = opening.shadow_terminator;
    const std::array<float, 3> b{1 - surface.u - surface.v, surface.u, surface.v};
    const Instance placed = geometry.instance_at(surface.instance, time);
    const Vec3f normal = n[0] * b[0] + n[1] * b[1] + n[2] * b[2];
    const auto to_world = [&](const Vec3f &d) {
        return Vec3f(dot(placed.linear[0], d), dot(placed.linear[1], d), dot(placed.linear[2], d));
    };
    const Vec3f direction = to_world(normal);
    away_ = direction * height(v, n, b, dot(direction, geometric) > 0);
}

Vec3f ShadowTerminator::offset(const Vec3f &to_light) const {
    if (!(cosine_ > 0))
        return {};
    const float of_smooth = std::abs(dot(smooth_, to_light)), of_geometric = dot(geometric_, to_light);
    const float amount = of_smooth < cosine_ ? 2 - (of_geometric + of_smooth) / cosine_ : 1 - of_geometric / cosine_;
    return away_ * std::clamp(amount, 0.0f, 1.0f);
}

} // namespace glimmer
