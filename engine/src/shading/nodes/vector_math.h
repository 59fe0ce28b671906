// SPDX-License-Identifier: GPL-3.0-or-later
// Vectors: Blender's Vector Math, Mapping and Vector Rotate nodes.
#pragma once

#include "shading/nodes/math.h"

#include <array>

namespace glimmer::nodes {

/// In the order of the op table (shading/ops.h).
enum class VectorMathKind : uint8_t {
    add,
    subtract,
    multiply,
    divide,
    multiply_add,
    cross_product,
    project,
    reflect,
    refract,
    faceforward,
    scale,
    normalize,
    absolute,
    minimum,
    maximum,
    floor,
    ceil,
    fraction,
    modulo,
    wrap,
    snap,
    sine,
    cosine,
    tangent,
    power,
    sign,
    round
};

template <class F>
Vec3f each(const Vec3f &a, const F &f) {
    return {f(a.x), f(a.y), f(a.z)};
}
template <class F>
Vec3f each(const Vec3f &a, const Vec3f &b, const F &f) {
    return {f(a.x, b.x), f(a.y, b.y), f(a.z, b.z)};
}

inline Vec3f product(const Vec3f &a, const Vec3f &b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}

/// A vector of length 0 stays.
inline Vec3f safe_normalize(const Vec3f &v) {
    const float size = length(v);
    return size > 0 ? v / size : v;
}

inline Vec3f reflected(const Vec3f &v, const Vec3f &unit) {
    return v - unit * (2 * dot(unit, v));
}

/// Snell's law with the ratio of indices eta; 0 in total reflection.
inline Vec3f refracted(const Vec3f &v, const Vec3f &n, float eta) {
    const float cosine = dot(n, v), k = 1 - eta * eta * (1 - cosine * cosine);
    return k < 0 ? Vec3f() : v * eta - n * (eta * cosine + std::sqrt(k));
}

inline Vec3f vector_math(VectorMathKind kind, const Vec3f &a, const Vec3f &b, const Vec3f &c, float scale) {
    using K = VectorMathKind;
    const auto by_number = [&](MathKind m) { return each(a, b, [m](float x, float y) { return math(m, x, y, 0); }); };
    const auto of_one = [&](MathKind m) { return each(a, [m](float x) { return math(m, x, 0, 0); }); };
    switch (kind) {
    case K::add:
        return a + b;
    case K::subtract:
        return a - b;
    case K::multiply:
        return product(a, b);
    case K::divide:
        return by_number(MathKind::divide);
    case K::multiply_add:
        return product(a, b) + c;
    case K::cross_product:
        return cross(a, b);
    case K::project: {
        const float size = dot(b, b);
        return size != 0 ? b * (dot(a, b) / size) : Vec3f();
    }
    case K::reflect:
        return reflected(a, safe_normalize(b));
    case K::refract:
        return refracted(a, safe_normalize(b), scale);
    case K::faceforward:
        return dot(c, b) < 0 ? a : -a;
    case K::scale:
        return a * scale;
    case K::normalize:
        return safe_normalize(a);
    case K::absolute:
        return of_one(MathKind::absolute);
    case K::minimum:
        return by_number(MathKind::minimum);
    case K::maximum:
        return by_number(MathKind::maximum);
    case K::floor:
        return of_one(MathKind::floor);
    case K::ceil:
        return of_one(MathKind::ceil);
    case K::fraction:
        return of_one(MathKind::fraction);
    case K::modulo:
        return by_number(MathKind::modulo);
    case K::wrap:
        return {nodes::wrap(a.x, b.x, c.x), nodes::wrap(a.y, b.y, c.y), nodes::wrap(a.z, b.z, c.z)};
    case K::snap:
        return by_number(MathKind::snap);
    case K::sine:
        return of_one(MathKind::sine);
    case K::cosine:
        return of_one(MathKind::cosine);
    case K::tangent:
        return of_one(MathKind::tangent);
    case K::power:
        return by_number(MathKind::power);
    case K::sign:
        return of_one(MathKind::sign);
    case K::round:
        return of_one(MathKind::round);
    }
    return {};
}

/// Rows of a rotation about x, then y, then z by the angles of a vector, in radians.
inline std::array<Vec3f, 3> euler_rotation(const Vec3f &angles) {
    const float cx = std::cos(angles.x), cy = std::cos(angles.y), cz = std::cos(angles.z);
    const float sx = std::sin(angles.x), sy = std::sin(angles.y), sz = std::sin(angles.z);
    return {Vec3f{cy * cz, sy * sx * cz - cx * sz, sy * cx * cz + sx * sz},
            Vec3f{cy * sz, sy * sx * sz + cx * cz, sy * cx * sz - sx * cz}, Vec3f{-sy, cy * sx, cy * cx}};
}
inline Vec3f rotated(const std::array<Vec3f, 3> &rows, const Vec3f &v) {
    return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)};
}
inline Vec3f rotated_back(const std::array<Vec3f, 3> &rows, const Vec3f &v) {
    return rows[0] * v.x + rows[1] * v.y + rows[2] * v.z;
}

enum class MappingKind : uint8_t { point, texture, vector, normal };

inline Vec3f mapping(MappingKind kind, const Vec3f &v, const Vec3f &location, const Vec3f &rotation,
                     const Vec3f &scale) {
    const auto rows = euler_rotation(rotation);
    const auto unscaled = [&](const Vec3f &x) { return each(x, scale, safe_divide); };
    switch (kind) {
    case MappingKind::point:
        return rotated(rows, product(v, scale)) + location;
    case MappingKind::texture:
        return unscaled(rotated_back(rows, v - location));
    case MappingKind::vector:
        return rotated(rows, product(v, scale));
    case MappingKind::normal:
        return safe_normalize(rotated(rows, unscaled(v)));
    }
    return v;
}

enum class RotateKind : uint8_t { axis_angle, x_axis, y_axis, z_axis, euler };

/// About a centre (Rodrigues' formula for an axis).
inline Vec3f vector_rotate(RotateKind kind, bool invert, const Vec3f &v, const Vec3f &center, const Vec3f &axis,
                           float angle, const Vec3f &euler) {
    if (kind == RotateKind::euler) {
        const auto rows = euler_rotation(euler);
        return (invert ? rotated_back(rows, v - center) : rotated(rows, v - center)) + center;
    }
    const Vec3f about = kind == RotateKind::x_axis   ? Vec3f(1, 0, 0)
                        : kind == RotateKind::y_axis ? Vec3f(0, 1, 0)
                        : kind == RotateKind::z_axis ? Vec3f(0, 0, 1)
                                                     : axis;
    const float size = length(about);
    if (!(size > 0))
        return v;
    const Vec3f k = about / size, p = v - center;
    const float theta = invert ? -angle : angle, cosine = std::cos(theta), sine = std::sin(theta);
    return p * cosine + cross(k, p) * sine + k * (dot(k, p) * (1 - cosine)) + center;
}

} // namespace glimmer::nodes
