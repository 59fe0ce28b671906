// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "math/vec.h"

#include <cstddef>
#include <cstdint>

namespace glimmer {

inline constexpr uint32_t kNone = 0xffffffffu;

/// A moment while the shutter is open, 0 to 1. A type of its own, so that no length is taken for one.
struct ShutterTime {
    float value = 0;
    constexpr ShutterTime() = default;
    explicit constexpr ShutterTime(float moment) : value(moment) {}
};

/// A half-line about the scene's origin (the camera), direction of unit length. Light takes no time: all rays of a
/// sample have the same.
struct Ray {
    Vec3f origin, direction;
    float t_max = kInfinity;
    ShutterTime time;

    Ray() = default;
    Ray(const Vec3f &o, const Vec3f &d, ShutterTime t, float most = kInfinity)
        : origin(o), direction(d), t_max(most), time(t) {}
};

/// What a ray is for, as far as what may be hidden from it goes. A ray that goes straight through a surface keeps its
/// kind.
enum class RayKind : uint8_t {
    camera,
    diffuse, ///< that leaves a diffuse lobe on the side it came from
    glossy,  ///< the same of any other lobe
    transmission,
    volume, ///< that the medium has scattered
    shadow  ///< between a point and a sample of a light
};
inline constexpr size_t kRayKinds = 6;

/// A set of ray kinds: a bit each, GLIMMER_RAY_CAMERA and so on.
using RayMask = uint8_t;
inline constexpr RayMask kEveryRay = (1 << kRayKinds) - 1;
constexpr RayMask mask_of(RayKind kind) {
    return RayMask(1 << unsigned(kind));
}

/// Whether rays of a kind meet a surface that is visible to these. What is visible to diffuse rays is so to rays in
/// the medium too, as in Cycles.
constexpr bool meets(RayKind kind, RayMask visible) {
    return visible & (kind == RayKind::volume ? mask_of(kind) | mask_of(RayKind::diffuse) : mask_of(kind));
}
/// Whether every kind but the camera's own sees it.
constexpr bool is_visible_beyond_camera(RayMask visible) {
    return (visible | mask_of(RayKind::camera)) == kEveryRay;
}
/// Whether paths meet what shadow rays meet.
constexpr bool shades_as_it_is_met(RayMask visible) {
    const bool shades = visible & mask_of(RayKind::shadow);
    for (const RayKind kind : {RayKind::diffuse, RayKind::glossy, RayKind::transmission, RayKind::volume})
        if (meets(kind, visible) != shades)
            return false;
    return true;
}

/// A part of a ray, by distances from its origin.
struct RayInterval {
    float begin, end;
};

/// The closest surface on a ray: a triangle of an instance, or a sphere.
struct Hit {
    float t = kInfinity;
    uint32_t instance = kNone;  ///< kNone: a sphere
    uint32_t primitive = kNone; ///< triangle of the mesh, or sphere
    float u = 0, v = 0;         ///< barycentrics of vertices 1 and 2
};

} // namespace glimmer
