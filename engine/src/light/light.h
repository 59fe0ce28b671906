// SPDX-License-Identifier: GPL-3.0-or-later
// Lights as plain values. Emissive surfaces (spheres, meshes) are met by rays like any surface; lamps are see-through,
// cast no shadow and are met only where an integrator asks for them; the sun and the environment are met by rays that
// leave the scene.
#pragma once

#include "geometry/ray.h"
#include "geometry/sphere.h"
#include "light/shapes/sphere.h"
#include "light/shapes/sun.h"
#include "math/vec.h"
#include "sampling/alias_table.h"
#include "sampling/distribution_2d.h"

#include <array>
#include <optional>
#include <variant>
#include <vector>

namespace glimmer {

/// A direction towards a light and what comes from there if nothing stands between (no transmittance).
struct LightSample {
    Vec3f direction;
    float distance;                  ///< a shadow ray runs so far; infinite for the sun and the environment
    Rgb radiance;                    ///< over the pdf's measure: for a delta light the intensity over distance^2
    float pdf;                       ///< per solid angle; 1 for a delta light
    bool delta;                      ///< cannot be met by chance
    uint32_t ignored_sphere = kNone; ///< the light itself, for the shadow ray
    float error = 0, facing = 1;     ///< of a shining triangle: of its positions, and |cos| there
};

/// What a ray finds of a see-through lamp.
struct LampHit {
    float t;
    Rgb radiance;
};

/// The cone of a spot: 1 inside, smoothly 0 at its edge, by the cosine of the angle to its axis.
struct SpotCone {
    Vec3f direction;
    float cos_half = -1, smooth = 0;

    float falloff(const Vec3f &from_light) const {
        const float over = dot(from_light, direction) - cos_half;
        if (over <= 0)
            return 0;
        if (over >= smooth)
            return 1;
        const float s = over / smooth;
        return s * s * (3 - 2 * s);
    }
};

struct SphereLight {
    Sphere sphere;
    Rgb radiance;
    uint32_t index; ///< of the scene's spheres
};

/// All emissive triangles of the scene, chosen by power.
struct MeshLight {
    struct Triangle {
        std::array<Vec3d, 3> vertices; ///< float64: a light a millionth of its distance wide keeps its area
        Rgb radiance;
        float error; ///< of positions on it
    };
    std::vector<Triangle> triangles;
    AliasTable choice;
    std::vector<uint32_t> first_of_instance; ///< kNone: not emissive; else + triangle = position in `triangle_of`
    std::vector<uint32_t> triangle_of;       ///< into triangles; kNone: this one does not shine
    Vec3f center;
    float radius = 0;
    Rgb intensity; ///< sum of area * radiance
};

struct PointLamp {
    Vec3f position;
    Rgb intensity;
    std::optional<SpotCone> cone;
};

struct SphereLamp {
    Sphere sphere;
    Rgb radiance;
    std::optional<SpotCone> cone;
};

struct AreaLamp {
    Vec3d center, half_x, half_y, normal; ///< shines along the normal
    bool ellipse;
    Rgb radiance;
};

struct SunLamp {
    SunDisk disk;
    Rgb irradiance; ///< at normal incidence
    Rgb radiance;   ///< of the disk; where it has no size, black
};

struct EnvironmentLight {
    Rgb color;
    std::vector<Rgb> pixels; ///< top row first; empty: constant
    uint32_t width = 0, height = 0;
    Distribution2d distribution;   ///< empty: constant
    std::array<Vec3f, 3> to_local; ///< rows
    Rgb mean;                      ///< over the sphere of directions

    Rgb radiance(const Vec3f &direction) const;
};

using Light = std::variant<SphereLight, MeshLight, PointLamp, SphereLamp, AreaLamp, SunLamp, EnvironmentLight>;

/// Towards the light from x. Nothing where it cannot shine.
std::optional<LightSample> sample_light(const Light &light, const Vec3f &x, Vec2f u);

inline std::optional<LightSample> sample_light(const SphereLight &light, const Vec3f &x, Vec2f u) {
    const auto s = sample_sphere(light.sphere.center - Vec3d(x), light.sphere.radius, u);
    if (!s)
        return std::nullopt;
    return LightSample{s->wi, s->distance, light.radiance, s->pdf, false, light.index};
}

/// The density, per solid angle at x, with which sample_light gives `direction`, known to meet the light. For a mesh
/// light `triangle` (of MeshLight::triangles) is the one met, `distance` away and seen under `cosine` from its normal.
/// 0 for a delta light.
float light_pdf(const Light &light, const Vec3f &x, const Vec3f &direction, uint32_t triangle = kNone,
                float distance = 0, float cosine = 0);

/// A see-through lamp on the ray, before its t_max. Nothing for other lights.
std::optional<LampHit> intersect_lamp(const Light &light, const Ray &ray);

/// What comes from infinitely far along the direction.
Rgb radiance_from_infinity(const Light &light, const Vec3f &direction);

/// A sphere around the light and about what it shines with: intensity for a finite light, irradiance for the sun and
/// the environment.
struct LightBound {
    Vec3f center;
    float radius = 0;
    bool infinite = false;
    float strength = 0;
};
LightBound bound_light(const Light &light);

} // namespace glimmer
