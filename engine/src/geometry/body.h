// SPDX-License-Identifier: GPL-3.0-or-later
// One instance or sphere by itself: where rays that start in it meet it, whatever else there is. Positions are about
// its centre, along the axes of the world, so that they are as precise as the body is, however far away it is.
#pragma once

#include "geometry/accel.h"

#include <optional>

namespace glimmer {

class Body {
  public:
    /// The body that a ray met. instance: kNone for a sphere, whose number is `primitive` then.
    Body(const Accel &geometry, uint32_t instance, uint32_t primitive, ShutterTime time);

    const Vec3d &center() const { return center_; } ///< about the scene's origin
    float radius() const { return radius_; }        ///< of a sphere about the centre that holds the body
    float error() const { return error_; }          ///< a bound on the rounding error of positions on the body
    /// A point of a triangle, by the barycentrics of its vertices 1 and 2; of a sphere, along a normal.
    Vec3f point(uint32_t triangle, float u, float v, const Vec3f &normal) const;
    std::optional<Hit> intersect(const Vec3f &origin, const Vec3f &direction, float t_max) const;

  private:
    const Accel &geometry_;
    uint32_t instance_, primitive_;
    Instance placed_;                 ///< of a mesh
    std::array<Vec3f, 3> to_local_{}; ///< rows; the inverse of its linear part
    Vec3d center_;
    float radius_, error_;
};

} // namespace glimmer
