// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/emission.h"

#include "sampling/warp.h"

#include <cmath>

namespace glimmer {

namespace {

/// A cosine-distributed ray from a point of a surface of uniform radiance, started off it by the rounding error.
Emission from_surface(const Vec3f &position, const Vec3f &normal, float error, const Rgb &radiance, double area,
                      Vec2f u) {
    const Vec3f local = sample_cosine_hemisphere(u);
    const Vec3f direction = normalize(Frame(normal).to_world(local));
    return {{position + normal * error, direction}, radiance * float(3.14159265358979323846 * area)};
}

} // namespace

std::optional<Emission> sample_emission(const Light &light, bool inwards, Vec2f u_position, Vec2f u_direction,
                                        float u_choice) {
    constexpr double kPiDouble = 3.14159265358979323846;
    if (const auto *l = std::get_if<SphereLight>(&light)) {
        const Vec3f normal = sample_uniform_sphere(u_position);
        const Vec3f position(l->sphere.center + Vec3d(normal) * l->sphere.radius);
        const double r = l->sphere.radius;
        return from_surface(position, inwards ? -normal : normal, 0x1p-20f * max_abs(position), l->radiance,
                            4 * kPiDouble * r * r, u_direction);
    }
    if (const auto *l = std::get_if<MeshLight>(&light)) {
        const AliasSample choice = l->choice.sample(u_choice);
        const MeshLight::Triangle &t = l->triangles[choice.index];
        const Barycentrics w = sample_triangle_barycentrics(u_position);
        const Vec3f position(t.vertices[0] * double(w.b0) + t.vertices[1] * double(w.b1) +
                             t.vertices[2] * double(w.b2));
        const Vec3d scaled = cross(t.vertices[1] - t.vertices[0], t.vertices[2] - t.vertices[0]);
        const double twice_area = length(scaled);
        const Vec3f normal = Vec3f(scaled / twice_area) * (choice.rest < 0.5f ? 1.0f : -1.0f);
        Emission e = from_surface(position, normal, t.error, t.radiance, twice_area, u_direction); // both sides
        e.power *= 1 / choice.pmf;
        return e;
    }
    if (const auto *l = std::get_if<PointLamp>(&light)) {
        if (!l->cone)
            return Emission{{l->position, sample_uniform_sphere(u_direction)}, l->intensity * (4 * kPi)};
        const float one_minus_cos = 1 - l->cone->cos_half;
        const Vec3f direction =
            normalize(Frame(l->cone->direction).to_world(sample_uniform_cone(one_minus_cos, u_direction)));
        return Emission{{l->position, direction},
                        l->intensity * (l->cone->falloff(direction) * 2 * kPi * one_minus_cos)};
    }
    if (const auto *l = std::get_if<SphereLamp>(&light)) {
        // Seen from without it is its near side, from within its far side: half the rays go in and end where they come
        // out.
        const bool in = u_choice < 0.5f;
        const Vec3f normal = sample_uniform_sphere(u_position) * (in ? -1.0f : 1.0f);
        const double r = l->sphere.radius;
        const Vec3f position(l->sphere.center + Vec3d(normal) * (in ? -r : r));
        Emission e = from_surface(position, normal, 0x1p-20f * max_abs(position), l->radiance, 8 * kPiDouble * r * r,
                                  u_direction);
        if (in)
            e.ray.t_max = float(2 * r) * dot(e.ray.direction, normal);
        if (l->cone)
            e.power *= l->cone->falloff(e.ray.direction);
        return e;
    }
    if (const auto *l = std::get_if<AreaLamp>(&light)) {
        double x = 2 * double(u_position.x) - 1, y = 2 * double(u_position.y) - 1;
        double area = 4 * length(l->half_x) * length(l->half_y);
        if (l->ellipse) {
            const Vec2f d = sample_uniform_disk(u_position);
            x = double(d.x), y = double(d.y);
            area *= kPiDouble / 4;
        }
        const Vec3f position(l->center + l->half_x * x + l->half_y * y);
        return from_surface(position, Vec3f(l->normal), 0, l->radiance, area, u_direction);
    }
    return std::nullopt;
}

} // namespace glimmer
