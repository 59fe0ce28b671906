// SPDX-License-Identifier: GPL-3.0-or-later
// A disk infinitely far away, or a single direction.
#pragma once

#include "light/interface.h"
#include "light/shapes/sun.h"

namespace glimmer {

struct SunLamp {
    SunDisk disk;
    Rgb irradiance; ///< at normal incidence
    Rgb radiance;   ///< of the disk; where it has no size, black

    static constexpr LightTraits traits{.infinite = true};
};

inline std::optional<LightSample> sample(const SunLamp &light, const Vec3f &, Vec2f u) {
    const DirectionSample s = sample_sun(light.disk, u);
    const bool delta = light.disk.is_delta();
    return LightSample{s.wi, s.distance, delta ? light.irradiance : light.radiance, s.pdf, delta};
}

inline float pdf(const SunLamp &light, const Vec3f &, const Vec3f &direction, const LightHit &) {
    return pdf_sun(light.disk, direction);
}

inline Rgb radiance_at_infinity(const SunLamp &light, const Vec3f &direction, uint8_t) {
    return pdf_sun(light.disk, direction) > 0 ? light.radiance : Rgb();
}

inline LightBound bound(const SunLamp &light) {
    return {.infinite = true, .strength = mean_component(light.irradiance)};
}

} // namespace glimmer
