// SPDX-License-Identifier: GPL-3.0-or-later
// What every kind of light is made of. A kind is a plain value in a file of its own, with free functions beside it:
//
//   static constexpr LightTraits traits;                   which of the functions below it has, and who meets it
//   sample(light, x, u)                                    a direction from x towards the light
//   pdf(light, x, direction, LightHit)                     its density; unless `delta`
//   intersect(light, ray)                                  if `intersectable`
//   radiance_at_infinity(light, direction, RayFlags)       if `infinite`
//   emit(light, inwards, u_position, EmissionDirection, u_choice) unless `infinite`
//   bound(light)                                           a sphere around it and its strength
//
// light.h lists the kinds and checks each against this page: one that lacks a function does not compile.
#pragma once

#include "geometry/ray.h"
#include "math/vec.h"

#include <algorithm>
#include <concepts>
#include <optional>

namespace glimmer {

struct LightTraits {
    bool delta = false;          ///< always a single point: no ray meets it by chance
    bool infinite = false;       ///< met by rays that leave the scene
    bool in_bvh = false;         ///< its surface is one of the scene's, which rays meet like any other
    bool intersectable = false;  ///< a see-through lamp: met only where an integrator asks for it
    bool camera_visible = false; ///< the camera's own rays meet it, if LightFlags say nothing else
};

/// What a scene may ask of a light beyond its kind.
struct LightFlags {
    RayMask visible = kEveryRay;  ///< rays that meet it, by the lobes that they left; at these it is sampled too
    bool shadows = true;          ///< false: nothing stands between it and a point that samples it
    uint32_t max_bounces = kNone; ///< it is sampled no more where the path has scattered more often before
    uint8_t group = 0;            ///< whose pass shows its light; 0: none. Of shining meshes each triangle's says so
    uint32_t profile = kNone;     ///< of a lamp whose light a program multiplies: its number there
    float profile_mean = 1;       ///< about the mean of that, to choose by
};

/// A direction towards a light and what comes from there if nothing stands between (no transmittance).
struct LightSample {
    Vec3f direction;
    float distance;                  ///< a shadow ray runs so far; infinite for the sun and the environment
    Rgb radiance;                    ///< over the pdf's measure: for a delta light the intensity over distance^2
    float pdf;                       ///< per solid angle; 1 for a delta light
    bool delta;                      ///< cannot be met by chance
    uint32_t ignored_sphere = kNone; ///< the light itself, for the shadow ray
    float error = 0, facing = 1;     ///< of a shining triangle: of its positions, and |cos| there
    RayMask visible = kEveryRay;     ///< LightFlags::visible
    bool shadows = true;             ///< LightFlags::shadows
    uint8_t group = 0;               ///< of a shining mesh: LightFlags::group
};

/// Where that is, as seen from x; at infinity its direction.
inline Vec3f at_light(const Vec3f &x, const LightSample &sample) {
    return sample.distance < kInfinity ? x + sample.direction * sample.distance : sample.direction;
}

/// Where a ray has met a light.
struct LightHit {
    float distance = kInfinity;
    uint32_t triangle = kNone; ///< of MeshLight::triangles
    float cosine = 1;          ///< |cos| between the ray and that triangle's normal
};

/// What a ray finds of a see-through lamp.
struct LampHit {
    float t;
    Rgb radiance;
};

/// A ray that carries `power` away from a light, in the sense that the mean over samples of power, spread along the
/// rays, is the light's own. The time is the caller's. t_max: how far it is that light's (the inside of a see-through
/// sphere).
struct Emission {
    Ray ray;
    Rgb power;
    float dark = 0; ///< length before the ray's beginning in which the light is hidden and absorbed, but not scattered
    uint8_t group = 0; ///< of a shining mesh: LightFlags::group
};

/// Which way light subpaths leave a light.
struct EmissionDirection {
    Vec2f u; ///< by which the light draws a direction, unless it is given
    Vec3f direction = {};
    float pdf = 0; ///< per solid angle, of `direction`, the same at all points of the light; 0: it is not given

    bool is_given() const { return pdf > 0; }
};

/// A sphere around the light and about what it shines with: intensity for a finite light, irradiance for the sun and
/// the environment.
struct LightBound {
    Vec3f center = {};
    float radius = 0;
    bool infinite = false;
    float strength = 0;
};

/// Intensity of a surface, for bounds. Radiance times area may be beyond float32 though a picture of it is not; it only
/// guides choices, so it is capped there (infinite weights would make every share of them NaN).
inline float bounded_strength(const Rgb &radiance, double area) {
    return float(std::min(double(mean_component(radiance)) * area, 1e30));
}

} // namespace glimmer
