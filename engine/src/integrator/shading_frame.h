// SPDX-License-Identifier: GPL-3.0-or-later
// Which normal a surface is shaded about, for paths from the camera and for light subpaths, which must agree.
#pragma once

#include "bsdf/bsdf.h"
#include "math/vec.h"

#include <algorithm>
#include <cmath>

namespace glimmer {

/// Whether light that leaves along wo is shaded about the shading normal, where nothing bends it. Where wo is below its
/// horizon, though not below the true surface, it is shaded about the true normal. Light subpaths decide by the
/// direction that they leave by, not by the one they come from, since a camera path along the same way arrives there.
/// shading: on the side of wo.
inline bool is_above_horizon(const Vec3f &shading, const Vec3f &wo) {
    return dot(wo, shading) > 1e-6f;
}

/// A shading normal, turned towards the true one as far as it takes for what is seen along wo to be reflected above the
/// surface. All on the side of wo. In the plane of both normals, at the angle p from the true one, what is reflected
/// has the cosine r cos(2p - q) to it, (r, q) being wo there in polar coordinates.
inline Vec3f bent_to_reflect(const Vec3f &shading, const Vec3f &geometric, const Vec3f &wo) {
    constexpr float kLeastCosine = 0.01f, kLeastShare = 0.9f; // of the reflected direction; or a share of that of wo
    const float z = dot(wo, geometric), least = std::min(kLeastShare * z, kLeastCosine);
    const Vec3f reflected = shading * (2 * dot(shading, wo)) - wo;
    const Vec3f aside = shading - geometric * dot(shading, geometric);
    const float size = length(aside);
    if (dot(reflected, geometric) >= least || !(size > 0))
        return shading;
    const float x = dot(wo, aside) / size, r = std::hypot(x, z);
    const float angle = 0.5f * (std::atan2(x, z) + std::acos(std::min(least / std::max(r, 1e-7f), 1.0f)));
    return aside * (std::sin(angle) / size) + geometric * std::cos(angle);
}

/// Whether shading normals are bent, as in Cycles, where they would send what is seen into the surface: where some of
/// it is reflected otherwise than diffusely and nothing passes to the other side. Not with mirrors where there are
/// light subpaths: all that a mirror with a bent normal shows comes from one cosine, which no light subpath meets.
inline bool bends_normals(const Bsdf &bsdf, bool with_light_subpaths) {
    bool glossy = false;
    for (const WeightedLobe &l : bsdf) {
        if (transmits(l.lobe) || (with_light_subpaths && is_specular(l.lobe)))
            return false;
        glossy |= !is_diffuse(l.lobe);
    }
    return glossy;
}

/// The normal about which light that leaves along wo is shaded. All on the side of wo.
inline Vec3f normal_towards(const Vec3f &shading, const Vec3f &geometric, const Vec3f &wo, const Bsdf &bsdf,
                            bool with_light_subpaths) {
    if (shading == geometric)
        return geometric;
    if (bends_normals(bsdf, with_light_subpaths))
        return bent_to_reflect(shading, geometric, wo);
    return is_above_horizon(shading, wo) ? shading : geometric;
}

/// The factor that flux has over radiance where a mirror or dielectric, shaded about n, sends it from wi towards wo
/// (both away from the surface): |wi.n| / |wi.ng| * |wo.ng| / |wo.n| (Veach 1997, section 5.3), without the 1/eta^2 of
/// flux that is refracted (adjoint_weight). wo_n: wo.n as it was sampled in the frame of n.
inline float scale_of_flux(const Vec3f &n, const Vec3f &geometric, const Vec3f &wi, const Vec3f &wo, float wo_n) {
    return std::abs((dot(wi, n) / dot(wi, geometric)) * (dot(wo, geometric) / std::max(wo_n, 1e-7f)));
}

} // namespace glimmer
