// SPDX-License-Identifier: GPL-3.0-or-later
// A ray at the boundary of a dielectric body: the relative index of refraction, the bodies around the ray beyond it and
// the frame to refract in. Camera paths and light subpaths share it.
#pragma once

#include "bsdf/dielectric.h"
#include "integrator/shading_frame.h"
#include "medium/interior_stack.h"
#include "scene/scene.h"

namespace glimmer {

struct DielectricCrossing {
    InteriorStack beyond;     ///< the bodies around the ray if it is transmitted
    float eta;                ///< index on the far side over the index on this side
    Vec3f geometric, shading; ///< unit normals on the side that the ray comes from
    Vec3f back;               ///< unit, from the surface to where the ray comes from
    bool about_shading;       ///< whether the frame stands on the shading normal or on the geometric one
    Frame frame;
    Vec3f outgoing; ///< `back` in the frame

    /// A sheet has no inside to be in: each of its faces is met alone, as all are in Cycles, with air before it.
    DielectricCrossing(const Scene &scene, const Interaction &surface, float interior_ior, const Vec3f &direction,
                       const InteriorStack &around)
        : beyond(around), back(-direction), frame(surface.shading_normal) {
        const bool entering = dot(back, surface.geometric_normal) > 0;
        if (scene.is_sheet(surface)) {
            eta = entering ? interior_ior : 1 / interior_ior;
        } else {
            if (entering)
                beyond.enter(surface.body, interior_ior, scene.within_glass());
            else
                beyond.leave(surface.body);
            // A ray that leaves a body which it never entered comes from that body's index.
            eta = beyond.ior() / (entering || !around.empty() ? around.ior() : interior_ior);
        }
        const float side = entering ? 1.0f : -1.0f;
        geometric = surface.geometric_normal * side;
        shading = surface.shading_normal * side;
        shade(is_above_horizon(shading, back));
    }

    /// Chooses the normal that the frame stands on.
    void shade(bool on_shading_normal) {
        about_shading = on_shading_normal;
        frame = Frame(about_shading ? shading : geometric);
        outgoing = frame.to_local(back);
        outgoing.z = std::max(outgoing.z, 1e-7f);
    }

    Vec3f to_world(const Vec3f &local) const { return normalize(frame.to_world(local)); }
    /// Whether a sampled direction lies on the side of the geometric surface that its kind of event requires.
    bool possible(const Vec3f &direction, bool transmitted) const {
        return (dot(direction, geometric) < 0) == transmitted;
    }
    /// Whether a camera path along the reversed direction would be shaded about this frame's normal too.
    bool holds_backwards(const Vec3f &direction, bool transmitted) const {
        return is_above_horizon(transmitted ? -shading : shading, direction) == about_shading;
    }
    /// Whether a direction sampled about the geometric normal may fall below the shading normal's horizon, which
    /// requires it to be no steeper than the angle between the two normals.
    bool may_leave_beneath_horizon() const {
        const float cos = dot(back, geometric), apart2 = length_squared(cross(shading, geometric));
        const float refracted2 = (cos * cos + (eta - 1) * (eta + 1)) / (eta * eta);
        return cos * cos <= apart2 || (refracted2 > 0 && refracted2 <= apart2);
    }
};

} // namespace glimmer
