// SPDX-License-Identifier: GPL-3.0-or-later
// Emission that shader programs give, as lights ask for it where they are sampled. What chooses among lights and their
// parts goes by means; the radiance of a sample is that of its own place, so that the choice need not know it.
#pragma once

#include "math/vec.h"

#include <cstdint>

namespace glimmer {

/// Where a lamp is met, and from where.
struct LampPlace {
    Vec3f position, normal; ///< of the lamp; its normal towards what it lights
    Vec3f wo;               ///< unit, from there to what it lights
    float distance = 0;     ///< to that; infinite for a sun
};

class VaryingEmission {
  public:
    virtual ~VaryingEmission() = default;

    /// Radiance of a triangle at the barycentrics (u, v) of its vertices 1 and 2, towards wo.
    virtual Rgb of_triangle(uint32_t instance, uint32_t primitive, Vec2f uv, const Vec3f &wo) const = 0;
    /// Of a sphere where its outward normal is `normal`.
    virtual Rgb of_sphere(uint32_t sphere, const Vec3f &normal, const Vec3f &wo) const = 0;
    /// Of the sky in a direction, for a ray of these RayFlags; sun_disc: with the disc of its sun, which is else a
    /// lamp.
    virtual Rgb of_sky(const Vec3f &direction, uint8_t ray, bool sun_disc) const = 0;
    /// What a lamp's light is multiplied by. profile: LightFlags::profile.
    virtual Rgb of_lamp(uint32_t profile, const LampPlace &place) const = 0;
};

} // namespace glimmer
