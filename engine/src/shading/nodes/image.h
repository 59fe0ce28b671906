// SPDX-License-Identifier: GPL-3.0-or-later
// Images on surfaces and skies: Blender's projections.
#pragma once

#include "shading/nodes/vector_math.h"
#include "shading/texture.h"

namespace glimmer::nodes {

enum class ProjectionKind : uint8_t { flat, box, sphere, tube, equirectangular, mirror_ball };

struct ImageMode {
    ProjectionKind projection;
    Interpolation interpolation;
    Extension extension;
    bool straight;
};

/// Longitude and latitude of a place around the middle of the unit cube.
inline Vec2f sphere_map(const Vec3f &p) {
    const float size = length(p);
    if (!(size > 0))
        return {0, 0};
    const float u = p.x == 0 && p.y == 0 ? 0.0f : (1 - std::atan2(p.x, p.y) / kPi) / 2;
    return {u, 1 - std::acos(std::clamp(p.z / size, -1.0f, 1.0f)) / kPi};
}

inline Vec2f tube_map(const Vec3f &p) {
    const float size = std::sqrt(p.x * p.x + p.y * p.y);
    if (!(size > 0))
        return {0, 0};
    return {(1 - std::atan2(p.x / size, p.y / size) / kPi) * 0.5f, (p.z + 1) * 0.5f};
}

inline Vec2f equirectangular_map(const Vec3f &direction) {
    const Vec3f d = safe_normalize(direction);
    if (d == Vec3f())
        return {0, 0};
    return {-std::atan2(d.y, d.x) / (2 * kPi) + 0.5f, std::atan2(d.z, std::sqrt(d.x * d.x + d.y * d.y)) / kPi + 0.5f};
}

/// A photograph of a mirrored ball, seen along y.
inline Vec2f mirror_ball_map(const Vec3f &direction) {
    const Vec3f d = safe_normalize(direction);
    const float y = d.y - 1, divisor = 2 * std::sqrt(std::max(-0.5f * y, 0.0f));
    const float u = divisor > 0 ? d.x / divisor : d.x, v = divisor > 0 ? d.z / divisor : d.z;
    return {0.5f * (u + 1), 0.5f * (v + 1)};
}

/// How much of each of the three pairs of a cube's faces a normal sees. The parts of |n| are barycentric coordinates in
/// a triangle with a face at each corner; blending takes strips along its edges and a triangle in its middle.
inline Vec3f box_weights(const Vec3f &normal, float blend) {
    Vec3f n{std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)};
    n = n / (n.x + n.y + n.z);
    const float limit = 0.5f * (1 + blend);
    if (n.x > limit * (n.x + n.y) && n.x > limit * (n.x + n.z))
        return {1, 0, 0};
    if (n.y > limit * (n.x + n.y) && n.y > limit * (n.y + n.z))
        return {0, 1, 0};
    if (n.z > limit * (n.x + n.z) && n.z > limit * (n.y + n.z))
        return {0, 0, 1};
    if (!(blend > 0))
        return {1, 0, 0};
    const auto between = [&](float a, float b) {
        return std::clamp((a / (a + b) - 0.5f * (1 - blend)) / blend, 0.0f, 1.0f);
    };
    if (n.z < (1 - limit) * (n.y + n.x)) {
        const float x = between(n.x, n.y);
        return {x, 1 - x, 0};
    }
    if (n.x < (1 - limit) * (n.y + n.z)) {
        const float y = between(n.y, n.z);
        return {0, y, 1 - y};
    }
    if (n.y < (1 - limit) * (n.x + n.z)) {
        const float x = between(n.x, n.z);
        return {x, 0, 1 - x};
    }
    return each(n, [&](float v) { return ((2 - limit) * v + (limit - 1)) / (2 * limit - 1); });
}

/// normal: of the object's own space, for boxes.
inline Texel image(const Texture &texture, const ImageMode &mode, const Vec3f &p, const Vec3f &normal, float blend) {
    const auto at = [&](float u, float v) {
        return texture.lookup(u, v, mode.interpolation, mode.extension, mode.straight);
    };
    const auto at_map = [&](const Vec2f &uv) { return at(uv.x, uv.y); };
    const Vec3f around = (p - Vec3f(0.5f, 0.5f, 0.5f)) * 2.0f;
    switch (mode.projection) {
    case ProjectionKind::sphere:
        return at_map(sphere_map(around));
    case ProjectionKind::tube:
        return at_map(tube_map(around));
    case ProjectionKind::equirectangular:
        return at_map(equirectangular_map(p));
    case ProjectionKind::mirror_ball:
        return at_map(mirror_ball_map(p));
    case ProjectionKind::box: {
        const Vec3f w = box_weights(normal, blend);
        Texel sum{0, 0, 0, 0}; // turned so that no face shows the image mirrored
        if (w.x > 0)
            sum = sum + at(normal.x < 0 ? 1 - p.y : p.y, p.z) * w.x;
        if (w.y > 0)
            sum = sum + at(normal.y > 0 ? 1 - p.x : p.x, p.z) * w.y;
        if (w.z > 0)
            sum = sum + at(normal.z > 0 ? 1 - p.y : p.y, p.x) * w.z;
        return sum;
    }
    case ProjectionKind::flat:
        break;
    }
    return at(p.x, p.y);
}

} // namespace glimmer::nodes
