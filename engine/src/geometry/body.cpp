// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/body.h"

#include "geometry/embree_geometry.h"
#include "math/rounding.h"

#include <cmath>

namespace glimmer {

Body::Body(const Accel &geometry, uint32_t instance, uint32_t primitive, ShutterTime time)
    : geometry_(geometry), instance_(instance), primitive_(primitive) {
    if (instance == kNone) {
        const Sphere &sphere = geometry.spheres()[primitive];
        center_ = sphere.center;
        radius_ = float(sphere.radius);
        error_ = kHitRounding * radius_;
        return;
    }
    placed_ = geometry.instance_at(instance, time);
    Linear linear;
    float norm2 = 0; // of Frobenius
    for (size_t r = 0; r < 3; ++r) {
        linear.rows[r] = Vec3d(placed_.linear[r]);
        norm2 += length_squared(placed_.linear[r]);
    }
    const Linear cofactor = linear.cofactor(); // the inverse is its transpose over the determinant
    const double scale = 1 / linear.determinant();
    for (int r = 0; r < 3; ++r)
        to_local_[size_t(r)] = Vec3f(cofactor.column(r) * scale);
    center_ = Vec3d(placed_.translation);
    radius_ = std::sqrt(3 * norm2) * placed_.mesh->radius; // of the corner of a cube
    error_ = kHitRounding * std::sqrt(norm2 / 3) * placed_.mesh->radius;
}

Vec3f Body::point(uint32_t triangle, float u, float v, const Vec3f &normal) const {
    if (instance_ == kNone)
        return normal * radius_;
    const Mesh &mesh = *placed_.mesh;
    const auto &corners = mesh.triangles[triangle];
    const Vec3f at =
        mesh.vertices[corners[0]] * (1 - u - v) + mesh.vertices[corners[1]] * u + mesh.vertices[corners[2]] * v;
    return {dot(placed_.linear[0], at), dot(placed_.linear[1], at), dot(placed_.linear[2], at)};
}

std::optional<Hit> Body::intersect(const Vec3f &origin, const Vec3f &direction, float t_max) const {
    if (instance_ == kNone) {
        const auto t = first_root(Sphere{{}, double(radius_)}, Vec3d(origin), Vec3d(direction), double(t_max));
        return t ? std::optional(Hit{*t, kNone, primitive_, 0, 0}) : std::nullopt;
    }
    const auto local = [&](const Vec3f &v) {
        return Vec3f(dot(to_local_[0], v), dot(to_local_[1], v), dot(to_local_[2], v));
    };
    const Vec3f o = local(origin), d = local(direction);
    constexpr float kMost = kMostCoordinate / 4;
    if (!(max_abs(o) < kMost) || !(max_abs(d) < kMost) || std::isnan(t_max))
        return std::nullopt;
    Ray ray;
    ray.origin = o;
    ray.direction = d;
    ray.t_max = t_max;
    RTCRayHit query{};
    query.ray = embree_ray(ray);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(geometry_.mesh_bvh(instance_), &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return std::nullopt;
    return Hit{query.ray.tfar, instance_, query.hit.primID, query.hit.u, query.hit.v};
}

} // namespace glimmer
