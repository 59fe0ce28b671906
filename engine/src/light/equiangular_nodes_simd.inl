// SPDX-License-Identifier: GPL-3.0-or-later
// The function of equiangular_nodes_simd.h, compiled once for each instruction set.
#pragma once

#include "light/equiangular_nodes_simd.h"
#include "math/simd/float16.h"
#include "medium/phase_simd.inl"

namespace glimmer {
namespace {

float table_nodes(const SimdMedium &medium, const TableShape &shape, float *density) {
    // All lengths are in units of h. In float64, since far from the light x is near 1, where 1 - x has no digits left
    // in float32. u: distance from the foot of the light on the line.
    double u[kTableNodes], du_dx[kTableNodes];
    const double per_h = 1 / shape.h, foot = shape.t_foot * per_h, cut = shape.cut * per_h;
    for (size_t i = 0; i < kTableNodes; ++i) {
        const double x = shape.x_first + shape.x_step * double(i), inverse = 1 / ((1 - x) * (1 + x));
        u[i] = i == 0 ? -foot : i == kTableNodes - 1 ? cut - foot : 2 * x * inverse;
        du_dx[i] = 2 * (1 + x * x) * inverse * inverse;
    }
    alignas(64) float from_foot[kTableNodes], from_start[kTableNodes], mirrored[kTableNodes], dx[kTableNodes];
    for (size_t i = 0; i < kTableNodes; ++i) {
        from_foot[i] = float(u[i]);
        from_start[i] = float(u[i] + foot);
        mirrored[i] = float(u[i] - foot);
        dx[i] = float(du_dx[i]);
    }
    const double radius = shape.radius * per_h, distance = shape.distance * per_h;
    const float nearest2 = float(shape.h2 * per_h * per_h), radius2 = float(radius * radius);
    const float start = float(distance), clipped = float((radius - distance) * (radius + distance));

    const Float16 s = Float16::load(from_foot), t = max(Float16::load(from_start), Float16());
    const Float16 squared_distance = Float16(nearest2) + s * s;
    // A node within the light counts as one on its surface; a point light has no surface, and h takes its place.
    const Float16 d2 = max(squared_distance, Float16(radius2 > 0 ? radius2 : 1.0f)), d = sqrt(d2);
    // The solid angle of the light over pi, which is 1 / d^2 for a point: 2 (1 - cos) of its cone over its radius^2, in
    // a form without cancellation.
    const Float16 sine2 = min(Float16(radius2) / d2, Float16(1.0f));
    Float16 source = Float16(2.0f) / (d2 * (Float16(1.0f) + sqrt(Float16(1.0f) - sine2)));
    if (medium.g != 0)
        source = source * phase_towards_line(medium.g, s, Float16(nearest2));
    // The optical path by way of t is t + d. Only its excess over the shortest, which is `distance`, enters, so that
    // the density does not underflow where the picture is all but black; d^2 - distance^2 = t (t - 2 t_foot) gives d -
    // distance without cancellation.
    const Float16 longer = max(t * Float16::load(mirrored), Float16(clipped)) / (d + Float16(start));
    const Float16 beyond = max(t + longer, Float16()) * Float16(float(shape.h));
    Float16 transmittance = exp(Float16(-medium.sigma_r) * beyond);
    if (!medium.monochromatic)
        transmittance =
            (transmittance + exp(Float16(-medium.sigma_g) * beyond) + exp(Float16(-medium.sigma_b) * beyond)) *
            Float16(1 / 3.0f);
    source = source * transmittance;
    max(source * Float16::load(dx), Float16(1e-36f)).store(density);
    float sources[kTableNodes];
    source.store(sources);
    return sources[kTableNodes - 1];
}

} // namespace
} // namespace glimmer
