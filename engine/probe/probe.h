// SPDX-License-Identifier: GPL-3.0-or-later
// For the tests alone: the kernels in bulk behind a C interface, for ctypes. Arrays are C-contiguous; shapes stand in
// brackets. Directions and colours are [n, 3], u is [n, 2]. No checks: the caller is tests/engine/probe.
#pragma once

#include "math/vec.h"

#include <cstdint>

#define PROBE extern "C" __attribute__((visibility("default")))

namespace glimmer::probe {

inline Vec2f load2(const float *p) {
    return {p[0], p[1]};
}
inline Vec3f load3(const float *p) {
    return {p[0], p[1], p[2]};
}
inline Vec3d load3(const double *p) {
    return {p[0], p[1], p[2]};
}
inline Rgb load_rgb(const float *p) {
    return {p[0], p[1], p[2]};
}
inline void store(float *p, const Vec2f &v) {
    p[0] = v.x, p[1] = v.y;
}
inline void store(float *p, const Vec3f &v) {
    p[0] = v.x, p[1] = v.y, p[2] = v.z;
}
inline void store(float *p, const Rgb &v) {
    p[0] = v.r, p[1] = v.g, p[2] = v.b;
}

} // namespace glimmer::probe
