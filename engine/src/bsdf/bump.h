// SPDX-License-Identifier: GPL-3.0-or-later
// What diffuse light loses where a bump or normal map turns a surface, so that its terminator stays where that of the
// smooth surface is, and soft.
#pragma once

#include "math/vec.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace glimmer {

enum class BumpSoftening : uint8_t {
    none,
    microfacet, ///< the masking of facets as steep (Conty Estevez, Lecocq, Stein 2019, "A Microfacet-Based Shadowing
                ///< Function to Solve the Bump Terminator Problem"); Cycles' from 4.5 on
    cubic       ///< Chiang, Li, Burley 2019, "Taming the Shadow Terminator"; Cycles' before
};

struct BumpShadow {
    Vec3f smooth; ///< the normal without bumps, in the frame about the bumped one
    BumpSoftening softening = BumpSoftening::none;
};

/// The part of diffuse light from wi that is left. Not reciprocal.
inline float bump_shadow(const BumpShadow &bump, const Vec3f &wi) {
    const float lit = dot(bump.smooth, wi), tilt = bump.smooth.z;
    if (bump.softening == BumpSoftening::cubic) {
        const float g = (wi.z < 0 ? -lit : lit) / (wi.z * tilt);
        return !(g > 0) ? 0.0f : g >= 1 ? 1.0f : g + g * g - g * g * g;
    }
    if (lit * tilt * wi.z < 0)
        return 0;
    const float cos_i2 = lit * lit, cos_d2 = tilt * tilt;
    if (cos_d2 >= 1 || cos_i2 >= 1)
        return 1;
    if (!(cos_i2 > 1e-12f))
        return 0;
    const float alpha2 = std::min(0.125f * (1 / cos_d2 - 1), 1.0f);
    return 2 / (1 + std::sqrt(1 + alpha2 * (1 / cos_i2 - 1)));
}

} // namespace glimmer
