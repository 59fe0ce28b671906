// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "math/vec.h"

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
