// SPDX-License-Identifier: GPL-3.0-or-later
// Where a surface is to be shaded: what every material needs is an Interaction, what only materials that vary ask for
// is found by a ShadingPoint when they do.
#pragma once

#include "bsdf/bump.h"
#include "geometry/accel.h"
#include "math/vec.h"
#include "shading/arrival.h"

#include <cmath>
#include <cstdint>

namespace glimmer {

/// The surface that a ray met.
struct Interaction {
    Vec3f position;
    Vec3f geometric_normal; ///< unit, outward as the mesh or sphere has it
    Vec3f shading_normal;   ///< unit, on the same side
    float error;            ///< bound on the rounding error of the position, in lengths
    uint32_t material;      ///< of Scene::materials
    uint32_t object_index;
    uint32_t body;             ///< the instance, or instances + sphere: which closed surface this is
    uint32_t instance = kNone; ///< kNone: a sphere
    uint32_t primitive = kNone;
    float u = 0, v = 0;                            ///< barycentrics of the triangle's vertices 1 and 2
    BumpSoftening softening = BumpSoftening::none; ///< of a bump that turned the shading normal
    Vec3f smooth_normal;                           ///< what it was before; set where there is a softening

    /// Where a ray that leaves to `direction` starts: off the surface, on its side, by the rounding error of the hit
    /// (Waechter and Binder, Ray Tracing Gems ch. 6, with the bound taken from the coordinates rather than a constant).
    Vec3f origin_towards(const Vec3f &direction) const {
        return position + geometric_normal * std::copysign(error, dot(direction, geometric_normal));
    }
};

/// From where, and how finely, a surface is looked at.
struct View {
    Vec3f wo;              ///< unit, away from the surface: where its light goes
    float footprint = 0;   ///< lengths: the width of what one sample stands for; 0: a point
    ShutterTime time = {}; ///< the moment: where a moving object stands
    Arrival arrival{};     ///< of the ray that looks
};

/// What the node of a shader program may ask. Positions are in the scene's coordinates, about its origin near the
/// camera; add `origin` for the caller's world.
class ShadingPoint {
  public:
    ShadingPoint(const Accel &geometry, const Vec3d &origin, const Interaction &surface, const View &view)
        : surface(surface), view(view), origin(origin), geometry_(geometry) {}

    const Interaction &surface;
    const View &view;
    const Vec3d &origin;

    bool is_moving() const { return !is_sphere() && geometry_.instances()[surface.instance].motion != kNone; }
    bool is_sphere() const { return surface.instance == kNone; }
    /// Asked only where is_sphere() is false.
    Instance instance() const { return geometry_.instance_at(surface.instance, view.time); }
    const Mesh &mesh() const { return *geometry_.instances()[surface.instance].mesh; }
    /// Asked only where is_sphere() is true.
    const Sphere &sphere() const { return geometry_.spheres()[surface.primitive]; }

    /// The weights of the triangle's three vertices.
    std::array<float, 3> weights() const { return {1 - surface.u - surface.v, surface.u, surface.v}; }
    /// Whether the ray meets the side that the normal points away from.
    bool is_backfacing() const { return dot(view.wo, surface.geometric_normal) < 0; }

    /// In the mesh's own coordinates, as the caller gave them; of a sphere, from its centre in units of its radius.
    Vec3d object_position() const;
    /// The mesh's texture coordinates; of a sphere, longitude about +z from -x and latitude, both 0 to 1.
    Vec2f uv() const;
    /// What the pass of texture coordinates shows: the mesh's attribute "uv" by corners, where it has one, or else
    /// uv().
    Vec2f map_uv() const;
    /// The derivative of the position by the first texture coordinate; any tangent where the mesh has none.
    Vec3f dpdu() const;

  private:
    const Accel &geometry_;
};

} // namespace glimmer
