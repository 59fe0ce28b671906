// SPDX-License-Identifier: GPL-3.0-or-later
// A ray at a boundary of glass: which indices meet there, and the frame to refract in. For camera and light paths
// alike.
#pragma once

#include "bsdf/glass.h"
#include "integrator/glass_stack.h"
#include "scene/scene.h"

namespace glimmer {

struct GlassCrossing {
    GlassStack beyond; ///< the bodies around the ray if it passes
    float eta;         ///< index on the other side / index on this side
    Vec3f geometric;   ///< on the ray's side
    Frame frame;
    Vec3f outgoing; ///< local, away from the surface, where the ray comes from

    GlassCrossing(const Interaction &surface, const Material &material, const Vec3f &direction,
                  const GlassStack &around)
        : beyond(around), geometric(surface.geometric_normal), frame(surface.shading_normal) {
        const Vec3f wo = -direction;
        const bool entering = dot(wo, surface.geometric_normal) > 0;
        if (entering)
            beyond.enter(surface.body, material.ior);
        else
            beyond.leave(surface.body);
        // Out of a body that was never entered (an open mesh): the index on this side is its own.
        eta = beyond.ior() / (entering || !around.empty() ? around.ior() : material.ior);
        const float side = entering ? 1.0f : -1.0f;
        geometric = surface.geometric_normal * side;
        const Vec3f shading = surface.shading_normal * side;
        frame = Frame(dot(wo, shading) > 1e-6f ? shading : geometric);
        outgoing = frame.to_local(wo);
        outgoing.z = std::max(outgoing.z, 1e-7f);
    }

    Vec3f to_world(const Vec3f &local) const { return normalize(frame.to_world(local)); }
    /// Whether a sampled direction is on the side of the true surface that it claims.
    bool possible(const Vec3f &direction, bool transmitted) const {
        return (dot(direction, geometric) < 0) == transmitted;
    }
};

/// The chance to go on after so many mirrors and sheets of glass in a row: total reflection can hold light in a body
/// for ever, at no loss that roulette by throughput would see.
inline float survival_of_chain(uint32_t chain) {
    return chain < 256 ? 1.0f : 0.98f;
}

} // namespace glimmer
