// SPDX-License-Identifier: GPL-3.0-or-later
// A sphere of the scene whose surface shines, outwards and inwards.
#pragma once

#include "geometry/sphere.h"
#include "light/emission.h"
#include "light/interface.h"
#include "light/shapes/sphere.h"
#include "light/varying_emission.h"

namespace glimmer {

struct SphereLight {
    Sphere sphere;
    Rgb radiance;
    uint32_t index;                           ///< of the scene's spheres
    const VaryingEmission *varying = nullptr; ///< then `radiance` is a mean

    Rgb radiance_at(const Vec3f &normal, const Vec3f &wo) const {
        return varying ? varying->of_sphere(index, normal, wo) : radiance;
    }

    static constexpr LightTraits traits{.in_bvh = true, .camera_visible = true};
};

inline std::optional<LightSample> sample(const SphereLight &light, const Vec3f &x, Vec2f u) {
    const auto s = sample_sphere(light.sphere.center - Vec3d(x), light.sphere.radius, u);
    if (!s)
        return std::nullopt;
    LightSample out{s->wi, s->distance, light.radiance, s->pdf, false, light.index};
    if (light.varying)
        out.radiance = light.radiance_at(
            Vec3f(normalize(Vec3d(x) + Vec3d(s->wi) * double(s->distance) - light.sphere.center)), -s->wi);
    return out;
}

inline float pdf(const SphereLight &light, const Vec3f &x, const Vec3f &, const LightHit &) {
    return pdf_sphere(light.sphere.center - Vec3d(x), light.sphere.radius);
}

inline Emission emit(const SphereLight &light, bool inwards, Vec2f u_position, const EmissionDirection &to, float) {
    const Vec3f normal = sample_uniform_sphere(u_position);
    const double r = light.sphere.radius;
    const Vec3f position(light.sphere.center + Vec3d(normal) * r);
    return emit_from_surface(position, inwards ? -normal : normal, kSampledPointRounding * max_abs(position),
                             4 * kPiDouble * r * r, to,
                             [&](const Vec3f &direction) { return light.radiance_at(normal, direction); });
}

inline LightBound bound(const SphereLight &light) {
    const double r = light.sphere.radius;
    return {Vec3f(light.sphere.center), float(r), false, bounded_strength(light.radiance, kPiDouble * r * r)};
}

} // namespace glimmer
