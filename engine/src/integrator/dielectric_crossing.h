// SPDX-License-Identifier: GPL-3.0-or-later
// A ray at a boundary of glass: which indices meet there, and the frame to refract in. For camera and light paths
// alike.
#pragma once

#include "bsdf/dielectric.h"
#include "integrator/shading_frame.h"
#include "medium/interior_stack.h"
#include "scene/scene.h"

namespace glimmer {

struct DielectricCrossing {
    InteriorStack beyond;     ///< the bodies around the ray if it passes
    float eta;                ///< index on the other side / index on this side
    Vec3f geometric, shading; ///< on the ray's side
    Vec3f back;               ///< away from the surface, where the ray comes from
    bool about_shading;       ///< the frame's normal
    Frame frame;
    Vec3f outgoing; ///< back, in the frame

    DielectricCrossing(const Interaction &surface, const Material &material, const Vec3f &direction,
                       const InteriorStack &around)
        : beyond(around), back(-direction), frame(surface.shading_normal) {
        const bool entering = dot(back, surface.geometric_normal) > 0;
        if (entering)
            beyond.enter(surface.body, material.ior);
        else
            beyond.leave(surface.body);
        // Out of a body that was never entered (an open mesh): the index on this side is its own.
        eta = beyond.ior() / (entering || !around.empty() ? around.ior() : material.ior);
        const float side = entering ? 1.0f : -1.0f;
        geometric = surface.geometric_normal * side;
        shading = surface.shading_normal * side;
        shade(is_above_horizon(shading, back));
    }

    void shade(bool about_shading_normal) {
        about_shading = about_shading_normal;
        frame = Frame(about_shading ? shading : geometric);
        outgoing = frame.to_local(back);
        outgoing.z = std::max(outgoing.z, 1e-7f);
    }

    Vec3f to_world(const Vec3f &local) const { return normalize(frame.to_world(local)); }
    /// Whether a sampled direction is on the side of the true surface that it claims.
    bool possible(const Vec3f &direction, bool transmitted) const {
        return (dot(direction, geometric) < 0) == transmitted;
    }
    /// Whether a path that comes from a sampled direction is shaded about the frame's normal, too.
    bool holds_backwards(const Vec3f &direction, bool transmitted) const {
        return is_above_horizon(transmitted ? -shading : shading, direction) == about_shading;
    }
    /// Whether a direction sampled about the true normal may be beneath the shading normal's horizon: it is no steeper
    /// then than the normals are apart.
    bool may_leave_beneath_horizon() const {
        const float cos = dot(back, geometric), apart2 = length_squared(cross(shading, geometric));
        const float refracted2 = (cos * cos + (eta - 1) * (eta + 1)) / (eta * eta);
        return cos * cos <= apart2 || (refracted2 > 0 && refracted2 <= apart2);
    }
};

/// The chance to go on after so many mirrors and sheets of glass in a row: total reflection can hold light in a body
/// for ever, at no loss that roulette by throughput would see.
inline float specular_survival(uint32_t specular_depth) {
    return specular_depth < 256 ? 1.0f : 0.98f;
}

} // namespace glimmer
