// SPDX-License-Identifier: GPL-3.0-or-later
// Nodes that look at the surface: Fresnel, Layer Weight, Bump.
#pragma once

#include "bsdf/fresnel.h"
#include "shading/nodes/vector_math.h"

namespace glimmer::nodes {

/// Reflectance of a dielectric of index `ior` seen from outside, or its inverse from within.
inline float fresnel(float ior, const Vec3f &normal, const Vec3f &incoming, bool backfacing) {
    const float eta = std::max(ior, 1e-5f);
    return fresnel_dielectric(std::min(std::abs(dot(normal, incoming)), 1.0f), backfacing ? 1 / eta : eta);
}

/// The Facing output of a Layer Weight node: 1 at grazing angles.
inline float facing(float blend, const Vec3f &normal, const Vec3f &incoming) {
    const float cosine = std::abs(dot(normal, incoming));
    const float b = std::clamp(blend, 0.0f, 1.0f - 1e-5f);
    return 1 - (b == 0.5f ? cosine : std::pow(cosine, b < 0.5f ? 2 * b : 0.5f / (1 - b)));
}

struct BumpInputs {
    float strength, distance, center, x, y; ///< the heights at a place and at two places beside it
    Vec3f normal;
    float filter_width; ///< how many steps of the two tangents those places are away
};

/// The normal of a surface of that height (Mikkelsen, Bump Mapping Unparametrized Surfaces on the GPU, 2010).
inline Vec3f bump(const BumpInputs &b, const Vec3f &dpdx, const Vec3f &dpdy) {
    const Vec3f rx = cross(dpdy, b.normal), ry = cross(b.normal, dpdx);
    const float determinant = dot(dpdx, rx);
    const Vec3f gradient = rx * (b.x - b.center) + ry * (b.y - b.center);
    const float sign = determinant < 0 ? -1.0f : 1.0f;
    const Vec3f bent =
        safe_normalize(b.normal * (b.filter_width * std::abs(determinant)) - gradient * (b.distance * sign));
    if (!(length_squared(bent) > 0))
        return b.normal;
    const float strength = std::max(b.strength, 0.0f);
    const Vec3f out = safe_normalize(bent * strength + b.normal * (1 - strength));
    return length_squared(out) > 0 && std::isfinite(out.x + out.y + out.z) ? out : b.normal;
}

} // namespace glimmer::nodes
