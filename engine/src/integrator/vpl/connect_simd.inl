// SPDX-License-Identifier: GPL-3.0-or-later
// The functions of connect_simd.h, compiled once for each instruction set.
#pragma once

#include "integrator/vpl/connect_simd.h"
#include "math/simd/float16.h"
#include "medium/phase_simd.inl"

namespace glimmer {
namespace {

struct Vec3x16 {
    Float16 x, y, z;
};

inline Vec3x16 from(const GatherPoint &p, const VertexColumns &v, size_t j) {
    return {Float16::load(v.x + j) - Float16(p.x), Float16::load(v.y + j) - Float16(p.y),
            Float16::load(v.z + j) - Float16(p.z)};
}
inline Float16 squared(const Vec3x16 &d) {
    return d.x * d.x + d.y * d.y + d.z * d.z;
}
/// Cosines between the vertices' direction of flight and the way to them from the gather point.
inline Float16 along_flight(const Vec3x16 &d, const VertexColumns &v, size_t j, Float16 inverse_length) {
    return (d.x * Float16::load(v.dx + j) + d.y * Float16::load(v.dy + j) + d.z * Float16::load(v.dz + j)) *
           inverse_length;
}

ConnectionSums connect(const SimdMedium &medium, const VertexColumns &vertices, size_t count, const GatherPoint &point,
                       float clamp_distance, const ConnectionParts &parts) {
    const Float16 d02(clamp_distance * clamp_distance), third(1 / 3.0f),
        isotropic(kSimdIsotropicPhase * kSimdIsotropicPhase);
    const Float16 sr(-medium.sigma_r), sg(-medium.sigma_g), sb(-medium.sigma_b);
    const Float16 sx(point.view_x), sy(point.view_y), sz(point.view_z);
    const SimdPhase phase(medium.g);
    Float16 red, green, blue, lanes;
    for (size_t j = 0; j < count; j += kSimdLanes) {
        const Vec3x16 way = from(point, vertices, j);
        const Float16 d2 = squared(way), d = sqrt(d2);
        Float16 scale = isotropic / (d2 + d02);
        if (vertices.dx) {
            const Float16 inverse_length = Float16(1.0f) / max(d, Float16(1e-30f));
            const Float16 here = (way.x * sx + way.y * sy + way.z * sz) * inverse_length;
            const Float16 there = along_flight(way, vertices, j, inverse_length);
            scale = phase(here) * phase(Float16() - there) / (d2 + d02);
        }
        const Float16 in_red = exp(sr * d) * scale;
        const Float16 r = in_red * Float16::load(vertices.r + j);
        const Float16 g = (medium.monochromatic ? in_red : exp(sg * d) * scale) * Float16::load(vertices.g + j);
        const Float16 b = (medium.monochromatic ? in_red : exp(sb * d) * scale) * Float16::load(vertices.b + j);
        const Float16 mean = (r + g + b) * third;
        mean.store(parts.mean + j);
        if (parts.r)
            r.store(parts.r + j), g.store(parts.g + j), b.store(parts.b + j);
        red = red + r, green = green + g, blue = blue + b, lanes = lanes + mean;
    }
    ConnectionSums sums;
    sums.r = sum(red), sums.g = sum(green), sums.b = sum(blue), sums.mean = sum(lanes);
    lanes.store(sums.by_lane);
    return sums;
}

void pick_targets(const SimdMedium &medium, const VertexColumns &vertices, size_t count, const GatherPoint *points,
                  size_t point_count, float clamp_distance, float *targets) {
    const Float16 sigma(-(medium.sigma_r + medium.sigma_g + medium.sigma_b) / 3), d02(clamp_distance * clamp_distance);
    const SimdPhase phase(medium.g);
    for (size_t j = 0; j < count; j += kSimdLanes) {
        Float16 target;
        for (size_t i = 0; i < point_count; ++i) {
            const Vec3x16 way = from(points[i], vertices, j);
            const Float16 d2 = squared(way), d = sqrt(d2);
            Float16 value = exp(sigma * d) / (d2 + d02);
            if (vertices.dx)
                value =
                    value * phase(Float16() - along_flight(way, vertices, j, Float16(1.0f) / max(d, Float16(1e-30f))));
            target = target + value;
        }
        target.store(targets + j);
    }
}

float diffuse(const PointColumns &points, size_t count, float x, float y, float z, float kappa, float softening2) {
    Float16 total;
    for (size_t i = 0; i < count; i += kSimdLanes) {
        const Vec3x16 way{Float16::load(points.x + i) - Float16(x), Float16::load(points.y + i) - Float16(y),
                          Float16::load(points.z + i) - Float16(z)};
        const Float16 d2 = squared(way);
        total = total + exp(Float16(-kappa) * sqrt(d2)) / sqrt(d2 + Float16(softening2));
    }
    return sum(total);
}

} // namespace
} // namespace glimmer
