// SPDX-License-Identifier: GPL-3.0-or-later
// Directions towards a disk infinitely far away.
#pragma once

#include "light/shapes/direction_sample.h"
#include "light/shapes/sphere.h"

#include <cmath>

namespace glimmer {

/// A cone of directions of uniform radiance about the direction towards the sun.
struct SunDisk {
    Vec3d towards;            ///< unit
    double one_minus_cos = 0; ///< of the half angle; 0 for a single direction

    SunDisk() = default;
    /// travels: direction of the light, not zero; angle: full, in degrees, 0 to 180.
    SunDisk(const Vec3d &travels, double angle_degrees) : towards(-normalize(travels)) {
        const double quarter = std::sin(angle_degrees * (kPiDouble / 720)); // of half the half angle
        one_minus_cos = 2 * quarter * quarter;
    }

    bool is_delta() const { return one_minus_cos == 0; }
    /// Irradiance at normal incidence per radiance: pi sin^2 of the half angle.
    double projected_solid_angle() const { return kPiDouble * one_minus_cos * (2 - one_minus_cos); }
};

/// For a single direction the pdf is 1, a probability: only sampling finds it.
inline DirectionSample sample_sun(const SunDisk &sun, Vec2f u) {
    if (sun.is_delta())
        return {Vec3f(sun.towards), kInfinity, 1};
    const double omc = static_cast<double>(u.x) * sun.one_minus_cos, sine = std::sqrt(omc * (2 - omc));
    const double phi = 2 * kPiDouble * static_cast<double>(u.y);
    const Vec3d wi = about_axis(sun.towards, sine * std::cos(phi), sine * std::sin(phi), 1 - omc);
    return {Vec3f(wi), kInfinity, static_cast<float>(1 / (2 * kPiDouble * sun.one_minus_cos))};
}

/// 0 outside the disk and for a single direction. |a - b|^2 / 2 = 1 - cos keeps its digits for a sun of half a degree.
inline float pdf_sun(const SunDisk &sun, const Vec3f &wi) {
    if (sun.is_delta() || length_squared(Vec3d(wi) - sun.towards) / 2 > sun.one_minus_cos)
        return 0;
    return static_cast<float>(1 / (2 * kPiDouble * sun.one_minus_cos));
}

} // namespace glimmer
