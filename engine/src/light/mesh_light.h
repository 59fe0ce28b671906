// SPDX-License-Identifier: GPL-3.0-or-later
// All emissive triangles of the scene as one light, chosen by power.
#pragma once

#include "light/emission.h"
#include "light/interface.h"
#include "light/shapes/triangle.h"
#include "light/varying_emission.h"
#include "sampling/alias_table.h"

#include <array>
#include <vector>

namespace glimmer {

struct MeshLight {
    struct Triangle {
        std::array<Vec3d, 3> vertices; ///< float64: a light a millionth of its distance wide keeps its area
        Rgb radiance;
        float error;                 ///< of positions on it
        RayMask visible = kEveryRay; ///< of its object
        uint8_t group = 0;           ///< LightFlags::group
    };
    std::vector<Triangle> triangles;
    AliasTable choice;
    std::vector<uint32_t> first_of_instance; ///< kNone: not emissive; else + triangle = position in `triangle_of`
    std::vector<uint32_t> triangle_of;       ///< into triangles; kNone: this one does not shine
    Vec3f center;
    float radius = 0;
    Rgb intensity; ///< sum of area * radiance

    /// Where triangles stand whose emission varies; of those the radiance above is a mean. Empty: no emission varies.
    struct Place {
        uint32_t instance = kNone, primitive = kNone; ///< kNone: this one's does not vary
    };
    std::vector<Place> places;
    const VaryingEmission *varying = nullptr;

    /// At the barycentrics of vertices 1 and 2.
    Rgb radiance_at(uint32_t triangle, Vec2f uv, const Vec3f &wo) const {
        if (places.empty() || places[triangle].instance == kNone)
            return triangles[triangle].radiance;
        return varying->of_triangle(places[triangle].instance, places[triangle].primitive, uv, wo);
    }

    static constexpr LightTraits traits{.in_bvh = true, .camera_visible = true};
};

inline std::optional<LightSample> sample(const MeshLight &light, const Vec3f &x, Vec2f u) {
    const AliasSample choice = light.choice.sample(u.x, u.y);
    const MeshLight::Triangle &t = light.triangles[choice.index];
    const Vec3d at(x), a = t.vertices[0] - at, b = t.vertices[1] - at, c = t.vertices[2] - at;
    const auto s = sample_triangle(a, b, c, {choice.rest, u.y});
    if (!s)
        return std::nullopt;
    const Vec3d normal = cross(b - a, c - a);
    const auto cosine = float(std::abs(dot(normal, Vec3d(s->wi))) / length(normal));
    LightSample out{s->wi, s->distance, t.radiance, s->pdf * choice.pmf, false, kNone, t.error, cosine};
    out.visible = t.visible;
    out.group = t.group;
    if (!light.places.empty()) {
        const Vec3d p = Vec3d(s->wi) * double(s->distance) - a, e1 = b - a, e2 = c - a;
        const double n2 = dot(normal, normal);
        const Vec2f uv{float(dot(cross(p, e2), normal) / n2), float(dot(cross(e1, p), normal) / n2)};
        out.radiance = light.radiance_at(choice.index, uv, -s->wi);
    }
    return out;
}

inline float pdf(const MeshLight &light, const Vec3f &, const Vec3f &, const LightHit &hit) {
    const MeshLight::Triangle &t = light.triangles[hit.triangle];
    const double area = 0.5 * length(cross(t.vertices[1] - t.vertices[0], t.vertices[2] - t.vertices[0]));
    const double d = double(hit.distance);
    return light.choice.pmf(hit.triangle) * float(pdf_area_to_solid_angle(d * d, double(hit.cosine), area));
}

/// To both sides of the triangles.
inline Emission emit(const MeshLight &light, bool, Vec2f u_position, const EmissionDirection &to, float u_choice) {
    const AliasSample choice = light.choice.sample(u_choice);
    const MeshLight::Triangle &t = light.triangles[choice.index];
    const Barycentrics w = sample_triangle_barycentrics(u_position);
    const Vec3f position(t.vertices[0] * double(w.b0) + t.vertices[1] * double(w.b1) + t.vertices[2] * double(w.b2));
    const Vec3d scaled = cross(t.vertices[1] - t.vertices[0], t.vertices[2] - t.vertices[0]);
    const double twice_area = length(scaled);
    const Vec3f normal = Vec3f(scaled / twice_area) * (choice.rest < 0.5f ? 1.0f : -1.0f);
    Emission e = emit_from_surface(position, normal, t.error, twice_area, to, [&](const Vec3f &direction) {
        return light.places.empty() ? t.radiance : light.radiance_at(choice.index, {w.b1, w.b2}, direction);
    });
    e.power *= 1 / choice.pmf;
    e.group = t.group;
    return e;
}

inline LightBound bound(const MeshLight &light) {
    return {light.center, light.radius, false, mean_component(light.intensity)};
}

} // namespace glimmer
