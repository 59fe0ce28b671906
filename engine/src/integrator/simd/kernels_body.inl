// SPDX-License-Identifier: GPL-3.0-or-later
// One source of the loops for every instruction set. Nothing here may have linkage, and nothing be called that has: an
// inline function compiled for AVX-512 could end up in the hands of a processor without it.
#pragma once

#include "integrator/simd/kernels.h"
#include "math/simd/float16.h"

namespace glimmer {
namespace {

constexpr float kEvenPhase = 0.0795774715f; // 1 / (4 pi)

/// The Henyey-Greenstein phase function of cosines between directions of propagation.
class Phases {
  public:
    explicit Phases(float g) : constant_(1 + g * g), slope_(2 * g), scale_((1 - g) * (1 + g) * kEvenPhase) {}
    Float16 operator()(Float16 cosine) const {
        const Float16 d2 = max(constant_ - slope_ * cosine, Float16(1e-12f));
        return scale_ / (d2 * sqrt(d2));
    }

  private:
    Float16 constant_, slope_, scale_;
};

/// The same where light from a point flies to s on a line and is scattered back along it, from how far 1 - cos is from
/// 0 at the peak: exact where 1 - cos would cancel, which decides at |g| > 0.99. nearest2: of the point to the line.
inline Float16 phase_towards_line(float g, Float16 s, Float16 nearest2) {
    const float h = g < 0 ? -g : g, narrow = 1 - h;
    const Float16 zero, away = g < 0 ? zero - s : s, d = sqrt(max(nearest2 + s * s, Float16(1e-30f)));
    const Float16 far = d + max(away, zero - away); // d + |s|
    const Float16 tail =
        (zero_where_below(away, zero, far) + zero_where_below(zero - away, Float16(1e-37f), nearest2 / far)) / d;
    const Float16 d2 = Float16(narrow * narrow) + Float16(2 * h) * tail;
    return Float16(narrow * (1 + h) * kEvenPhase) / (d2 * sqrt(d2));
}

struct Differences {
    Float16 x, y, z;
};

inline Differences from(const SeenPoint &p, const VertexColumns &v, size_t j) {
    return {Float16::load(v.x + j) - Float16(p.x), Float16::load(v.y + j) - Float16(p.y),
            Float16::load(v.z + j) - Float16(p.z)};
}
inline Float16 squared(const Differences &d) {
    return d.x * d.x + d.y * d.y + d.z * d.z;
}
/// Cosines, at the vertices, between their flight and the way from the point.
inline Float16 along_flight(const Differences &d, const VertexColumns &v, size_t j, Float16 inverse_length) {
    return (d.x * Float16::load(v.dx + j) + d.y * Float16::load(v.dy + j) + d.z * Float16::load(v.dz + j)) *
           inverse_length;
}

ConnectionSums connect(const SimdMedium &medium, const VertexColumns &vertices, size_t count, const SeenPoint &point,
                       float bound, float *parts) {
    const Float16 bound2(bound * bound), third(1 / 3.0f), even(kEvenPhase * kEvenPhase);
    const Float16 sr(-medium.sigma_r), sg(-medium.sigma_g), sb(-medium.sigma_b);
    const Float16 sx(point.seen_x), sy(point.seen_y), sz(point.seen_z);
    const Phases phases(medium.g);
    Float16 red, green, blue, lanes;
    for (size_t j = 0; j < count; j += kSimdLanes) {
        const Differences way = from(point, vertices, j);
        const Float16 d2 = squared(way), d = sqrt(d2);
        Float16 scale = even / (d2 + bound2);
        if (vertices.dx) {
            const Float16 inverse_length = Float16(1.0f) / max(d, Float16(1e-30f));
            const Float16 here = (way.x * sx + way.y * sy + way.z * sz) * inverse_length;
            const Float16 there = along_flight(way, vertices, j, inverse_length);
            scale = phases(here) * phases(Float16() - there) / (d2 + bound2);
        }
        const Float16 in_red = exp(sr * d) * scale;
        const Float16 r = in_red * Float16::load(vertices.r + j);
        const Float16 g = (medium.monochromatic ? in_red : exp(sg * d) * scale) * Float16::load(vertices.g + j);
        const Float16 b = (medium.monochromatic ? in_red : exp(sb * d) * scale) * Float16::load(vertices.b + j);
        const Float16 part = (r + g + b) * third;
        part.store(parts + j);
        red = red + r, green = green + g, blue = blue + b, lanes = lanes + part;
    }
    ConnectionSums sums;
    sums.r = sum(red), sums.g = sum(green), sums.b = sum(blue), sums.part = sum(lanes);
    lanes.store(sums.by_lane);
    return sums;
}

void weigh(const SimdMedium &medium, const VertexColumns &vertices, size_t count, const SeenPoint *points,
           size_t point_count, float soften, float *targets) {
    const Float16 sigma(-(medium.sigma_r + medium.sigma_g + medium.sigma_b) / 3), soften2(soften * soften);
    const Phases phases(medium.g);
    for (size_t j = 0; j < count; j += kSimdLanes) {
        Float16 near;
        for (size_t i = 0; i < point_count; ++i) {
            const Differences way = from(points[i], vertices, j);
            const Float16 d2 = squared(way), d = sqrt(d2);
            Float16 value = exp(sigma * d) / (d2 + soften2);
            if (vertices.dx)
                value = value * phases(Float16() - along_flight(way, vertices, j, //
                                                                Float16(1.0f) / max(d, Float16(1e-30f))));
            near = near + value;
        }
        near.store(targets + j);
    }
}

float table_nodes(const SimdMedium &medium, const TableShape &shape, float *density) {
    // In lengths of h. x is near 1 far from the light, where 1 - x has no digits in float32.
    double u[kTableNodes], stretch[kTableNodes]; // from the foot; du / dx
    const double per_h = 1 / shape.h, foot = shape.t_foot * per_h, cut = shape.cut * per_h;
    for (size_t i = 0; i < kTableNodes; ++i) {
        const double x = shape.x_first + shape.x_step * double(i), inverse = 1 / ((1 - x) * (1 + x));
        u[i] = i == 0 ? -foot : i == kTableNodes - 1 ? cut - foot : 2 * x * inverse;
        stretch[i] = 2 * (1 + x * x) * inverse * inverse;
    }
    alignas(64) float from_foot[kTableNodes], from_start[kTableNodes], mirrored[kTableNodes], dx[kTableNodes];
    for (size_t i = 0; i < kTableNodes; ++i) {
        from_foot[i] = float(u[i]);
        from_start[i] = float(u[i] + foot);
        mirrored[i] = float(u[i] - foot);
        dx[i] = float(stretch[i]);
    }
    const double radius = shape.radius * per_h, distance = shape.distance * per_h;
    const float nearest2 = float(shape.h2 * per_h * per_h), radius2 = float(radius * radius);
    const float start = float(distance), clipped = float((radius - distance) * (radius + distance));

    const Float16 s = Float16::load(from_foot), t = max(Float16::load(from_start), Float16());
    const Float16 squared_distance = Float16(nearest2) + s * s;
    // Within the light, as on its surface; a point has no surface, and h instead.
    const Float16 d2 = max(squared_distance, Float16(radius2 > 0 ? radius2 : 1.0f)), d = sqrt(d2);
    // 1 / d^2 times what the cone of a sphere has more than that: 2 (1 - cos), without its cancellation.
    const Float16 sine2 = min(Float16(radius2) / d2, Float16(1.0f));
    Float16 source = Float16(2.0f) / (d2 * (Float16(1.0f) + sqrt(Float16(1.0f) - sine2)));
    if (medium.g != 0)
        source = source * phase_towards_line(medium.g, s, Float16(nearest2));
    // The way by way of t, past the shortest: t + d - distance, where d^2 - distance^2 = t (t - 2 t_foot). Only so much
    // of it decides: the density does not underflow where the picture is all but black.
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
