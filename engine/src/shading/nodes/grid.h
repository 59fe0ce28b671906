// SPDX-License-Identifier: GPL-3.0-or-later
// Voxels: a float texture whose rows are those of a three-dimensional grid, slice after slice.
#pragma once

#include "math/vec.h"
#include "shading/texture.h"

#include <cmath>
#include <cstdint>

namespace glimmer::nodes {

/// The value at p, voxels at whole numbers from 0 on; between them linear, or that of the closest. size: of the grid,
/// (x, y, z); the texture has x columns and y times z rows. What is outside is 0.
inline Vec3f grid(const Texture &voxels, const Vec3f &p, const Vec3f &size, bool closest) {
    const auto nx = int64_t(size.x), ny = int64_t(size.y), nz = int64_t(size.z);
    const auto inside = [](float x, int64_t n) { return x > -1 && x < float(n); }; // false for NaN
    if (voxels.floats.empty() || nx != int64_t(voxels.width) || ny < 1 || nz < 1 || ny > int64_t(voxels.height) / nz ||
        !inside(p.x, nx) || !inside(p.y, ny) || !inside(p.z, nz))
        return {};
    const auto voxel = [&](int64_t x, int64_t y, int64_t z) -> Vec3f {
        if (x < 0 || y < 0 || z < 0 || x >= nx || y >= ny || z >= nz)
            return {};
        const float *v = voxels.floats.data() + ((z * ny + y) * nx + x) * int64_t(voxels.channels);
        return voxels.channels < 3 ? Vec3f(v[0], v[0], v[0]) : Vec3f(v[0], v[1], v[2]);
    };
    if (closest)
        return voxel(std::lround(p.x), std::lround(p.y), std::lround(p.z));
    const float x = std::floor(p.x), y = std::floor(p.y), z = std::floor(p.z);
    const float u = p.x - x, v = p.y - y, w = p.z - z;
    Vec3f sum;
    for (int corner = 0; corner < 8; ++corner) {
        const int i = corner & 1, j = corner >> 1 & 1, k = corner >> 2;
        const float weight = (i ? u : 1 - u) * (j ? v : 1 - v) * (k ? w : 1 - w);
        if (weight > 0)
            sum += voxel(int64_t(x) + i, int64_t(y) + j, int64_t(z) + k) * weight;
    }
    return sum;
}

} // namespace glimmer::nodes
