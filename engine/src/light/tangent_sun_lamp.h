// SPDX-License-Identifier: GPL-3.0-or-later
// A sun as Cycles had it until 3.6: light of one strength from every point of a disk on the plane at the distance 1
// that faces the receiver. Seen as radiance it grows towards the rim, as 1/cos^3 of the angle to the middle.
#pragma once

#include "light/interface.h"
#include "light/shapes/direction_sample.h"
#include "light/shapes/sphere.h"
#include "sampling/warp.h"

#include <algorithm>
#include <cmath>

namespace glimmer {

struct TangentSunLamp {
    Vec3d towards; ///< unit
    double radius; ///< of the disk: tan of the half angle
    Rgb strength;  ///< irradiance at normal incidence, were all of it from the middle

    static constexpr LightTraits traits{.infinite = true};
    static constexpr double kMostRadius = 2e7; ///< of a half angle of 90 degrees

    /// travels: direction of the light, not zero; angle: full, in degrees, above 0, up to 180.
    TangentSunLamp(const Vec3d &travels, double angle_degrees, const Rgb &strength_)
        : towards(-normalize(travels)),
          radius(angle_degrees < 180 ? std::min(std::tan(angle_degrees * kPiDouble / 360), kMostRadius) : kMostRadius),
          strength(strength_) {}

    double density(double cosine) const { return 1 / (kPiDouble * radius * radius * cosine * cosine * cosine); }
};

inline std::optional<LightSample> sample(const TangentSunLamp &light, const Vec3f &, Vec2f u) {
    const Vec2f on = sample_uniform_disk(u);
    const double x = double(on.x) * light.radius, y = double(on.y) * light.radius;
    const double cosine = 1 / std::sqrt(1 + x * x + y * y);
    const auto density = float(light.density(cosine));
    return LightSample{Vec3f(about_axis(light.towards, x * cosine, y * cosine, cosine)), kInfinity,
                       light.strength * density, density, false};
}

inline float pdf(const TangentSunLamp &light, const Vec3f &, const Vec3f &direction, const LightHit &) {
    const Vec3d wi(direction);
    const double cosine = dot(wi, light.towards);
    if (!(cosine > 0) || length(cross(wi, light.towards)) > light.radius * cosine)
        return 0;
    return float(light.density(cosine));
}

inline Rgb radiance_at_infinity(const TangentSunLamp &light, const Vec3f &direction, uint8_t) {
    return light.strength * pdf(light, {}, direction, {});
}

inline LightBound bound(const TangentSunLamp &light) {
    return {.infinite = true, .strength = mean_component(light.strength)};
}

} // namespace glimmer
