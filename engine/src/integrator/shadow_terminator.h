// SPDX-License-Identifier: GPL-3.0-or-later
// The terminator of smooth meshes: where light grazes a curved surface its triangles turn away from the light, or hide
// it from each other, before the surface that their normals stand for does. As in Cycles, rays to lights start from
// that surface there, and reach lights that are beneath the triangle's horizon but not beneath the normal's.
#pragma once

#include "geometry/accel.h"
#include "shading/shading_point.h"

namespace glimmer {

class ShadowTerminator {
  public:
    /// None.
    ShadowTerminator() = default;
    /// geometric: the unit normal on the side that is lit. shading: that which it is shaded with.
    ShadowTerminator(const Accel &geometry, const Interaction &surface, const Vec3f &geometric, const Vec3f &shading,
                     ShutterTime time);

    explicit operator bool() const { return cosine_ > 0; }
    /// Whether a light is above the curved surface, which may be beneath the horizon of the triangle. Bumps do not see
    /// what is beneath it, though they turn there.
    bool faces(const Vec3f &to_light) const { return dot(smooth_, to_light) > 0; }
    /// How far rays towards a light start from the triangle.
    Vec3f offset(const Vec3f &to_light) const;

  private:
    float cosine_ = 0; ///< below which light grazes
    Vec3f geometric_, smooth_;
    Vec3f away_; ///< from the triangle to the curved surface
};

} // namespace glimmer
