// SPDX-License-Identifier: GPL-3.0-or-later
// Lights as plain values. Emissive surfaces (spheres, meshes) are met by rays like any surface; lamps are see-through,
// cast no shadow and are met only where an integrator asks for them; the sun and the environment are met by rays that
// leave the scene. A new kind is a file like light/sun_lamp.h and a name in the variant below.
#pragma once

#include "light/area_lamp.h"
#include "light/disk_lamp.h"
#include "light/environment_light.h"
#include "light/interface.h"
#include "light/mesh_light.h"
#include "light/point_lamp.h"
#include "light/sphere_lamp.h"
#include "light/sphere_light.h"
#include "light/sun_lamp.h"
#include "light/tangent_sun_lamp.h"

#include <variant>

namespace glimmer {

using Light = std::variant<SphereLight, MeshLight, PointLamp, SphereLamp, DiskLamp, AreaLamp, SunLamp, TangentSunLamp,
                           EnvironmentLight>;

/// What interface.h asks of a kind.
template <class L>
concept LightKind = requires(const L &light, const Vec3f &v, Vec2f u, const LightHit &hit, const Ray &ray) {
    { L::traits } -> std::same_as<const LightTraits &>;
    { sample(light, v, u) } -> std::same_as<std::optional<LightSample>>;
    { bound(light) } -> std::same_as<LightBound>;
    requires L::traits.delta || requires {
        { pdf(light, v, v, hit) } -> std::same_as<float>;
    };
    requires !L::traits.intersectable || requires {
        { intersect(light, ray) } -> std::same_as<std::optional<LampHit>>;
    };
    requires !L::traits.infinite || requires {
        { radiance_at_infinity(light, v, uint8_t{}) } -> std::same_as<Rgb>;
    };
    requires L::traits.infinite || requires {
        { emit(light, false, u, EmissionDirection{u}, 0.0f) } -> std::same_as<Emission>;
    };
    // Rays meet a light in one way, or not at all.
    requires int(L::traits.delta) + L::traits.infinite + L::traits.in_bvh + L::traits.intersectable == 1;
};

template <class>
inline constexpr bool kAllAreLights = false;
template <LightKind... Kinds>
inline constexpr bool kAllAreLights<std::variant<Kinds...>> = true;
static_assert(kAllAreLights<Light>, "a kind of light lacks something that light/interface.h asks for");

inline const LightTraits &traits(const Light &light) {
    return std::visit([](const auto &l) -> const LightTraits & { return l.traits; }, light);
}

/// The one kind that the kernels without KernelFeatures::other_lights know. Its bound is its very surface, and only the
/// side on which the camera is can shine into the picture.
inline bool is_emissive_sphere(const Light &light) {
    return std::holds_alternative<SphereLight>(light);
}

/// Towards the light from x. Nothing where it cannot shine.
std::optional<LightSample> sample_light(const Light &light, const Vec3f &x, Vec2f u);

/// The same for a light that is an emissive sphere, inline for those kernels.
inline std::optional<LightSample> sample_emissive_sphere(const Light &light, const Vec3f &x, Vec2f u) {
    return sample(std::get<SphereLight>(light), x, u);
}

/// The density, per solid angle at x, with which sample_light gives `direction`, known to meet the light at `hit`. 0
/// for a delta light.
float light_pdf(const Light &light, const Vec3f &x, const Vec3f &direction, const LightHit &hit);

/// A see-through lamp on the ray, before its t_max. Nothing for other lights.
std::optional<LampHit> intersect_lamp(const Light &light, const Ray &ray);

/// What comes from infinitely far along the direction. ray: RayFlags, for skies that differ by them.
Rgb radiance_from_infinity(const Light &light, const Vec3f &direction, uint8_t ray);

LightBound bound_light(const Light &light);

/// The normal of a lamp at a point of it, which shines towards wo: lamps without a shape of their own face all.
Vec3f lamp_normal(const Light &light, const Vec3f &position, const Vec3f &wo);

/// For finite lights; nothing for the sun and the environment. `inwards`: the light is a sphere around all that is to
/// be seen.
std::optional<Emission> sample_emission(const Light &light, bool inwards, Vec2f u_position, const EmissionDirection &to,
                                        float u_choice);

} // namespace glimmer
