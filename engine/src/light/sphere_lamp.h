// SPDX-License-Identifier: GPL-3.0-or-later
// A see-through sphere that shines, or a spot of that kind: its radiance is uniform, but for the cone.
#pragma once

#include "geometry/sphere.h"
#include "light/emission.h"
#include "light/interface.h"
#include "light/shapes/sphere.h"
#include "light/spot_cone.h"

namespace glimmer {

struct SphereLamp {
    Sphere sphere;
    Rgb radiance;
    std::optional<SpotCone> cone;

    static constexpr LightTraits traits{.intersectable = true};
};

inline std::optional<LightSample> sample(const SphereLamp &light, const Vec3f &x, Vec2f u) {
    const auto s = sample_sphere(light.sphere.center - Vec3d(x), light.sphere.radius, u);
    if (!s)
        return std::nullopt;
    const float factor = falloff(light.cone, -s->wi);
    if (factor == 0)
        return std::nullopt;
    return LightSample{s->wi, s->distance, light.radiance * factor, s->pdf, false};
}

inline float pdf(const SphereLamp &light, const Vec3f &x, const Vec3f &, const LightHit &) {
    return pdf_sphere(light.sphere.center - Vec3d(x), light.sphere.radius);
}

/// The near side, or from within the far side.
inline std::optional<LampHit> intersect(const SphereLamp &light, const Ray &ray) {
    const auto roots = intersect_sphere(light.sphere, Vec3d(ray.origin), Vec3d(ray.direction));
    if (!roots)
        return std::nullopt;
    const auto t = float(roots->near > 0 ? roots->near : roots->far);
    if (!(t > 0 && t < ray.t_max))
        return std::nullopt;
    const float factor = falloff(light.cone, -ray.direction);
    if (factor == 0)
        return std::nullopt;
    return LampHit{t, light.radiance * factor};
}

/// Seen from without it is its near side, from within its far side: half the rays go in and end where they come out.
inline Emission emit(const SphereLamp &light, bool, Vec2f u_position, const EmissionDirection &to, float u_choice) {
    const bool in = u_choice < 0.5f;
    const Vec3f normal = sample_uniform_sphere(u_position) * (in ? -1.0f : 1.0f);
    const double r = light.sphere.radius;
    const Vec3f position(light.sphere.center + Vec3d(normal) * (in ? -r : r));
    Emission e = emit_from_surface(position, normal, kSampledPointRounding * max_abs(position), 8 * kPiDouble * r * r,
                                   to, [&](const Vec3f &) { return light.radiance; });
    if (in)
        e.ray.t_max = float(2 * r) * dot(e.ray.direction, normal);
    if (light.cone)
        e.power *= light.cone->falloff(e.ray.direction);
    return e;
}

inline LightBound bound(const SphereLamp &light) {
    const double r = light.sphere.radius;
    return {Vec3f(light.sphere.center), float(r), false, bounded_strength(light.radiance, kPiDouble * r * r)};
}

} // namespace glimmer
