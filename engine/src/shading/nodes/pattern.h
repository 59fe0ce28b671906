// SPDX-License-Identifier: GPL-3.0-or-later
// Blender's textures without a lattice: wave, checker, gradient, magic, brick.
#pragma once

#include "shading/nodes/noise.h"
#include "shading/nodes/vector_math.h"

namespace glimmer::nodes {

/// Off the planes between cells, on which the faces of a unit cube lie.
inline Vec3f off_the_grid(const Vec3f &p) {
    return (p + Vec3f(1e-6f, 1e-6f, 1e-6f)) * 0.999999f;
}

enum class WaveKind : uint8_t { bands, rings };
enum class WaveAxis : uint8_t { x, y, z, diagonal }; ///< of rings the last is spherical
enum class WaveProfile : uint8_t { sine, saw, triangle };

struct WaveParameters {
    float distortion, detail, detail_scale, detail_roughness, phase;
    WaveKind kind;
    WaveAxis axis;
    WaveProfile profile;
    bool before_4;
};

/// p: already scaled.
inline float wave(const Vec3f &at, const WaveParameters &w) {
    const Vec3f p = off_the_grid(at);
    float n = 0;
    if (w.kind == WaveKind::bands) {
        n = w.axis == WaveAxis::x   ? p.x * 20
            : w.axis == WaveAxis::y ? p.y * 20
            : w.axis == WaveAxis::z ? p.z * 20
                                    : (p.x + p.y + p.z) * 10;
    } else {
        Vec3f r = p;
        r.x = w.axis == WaveAxis::x ? 0 : r.x;
        r.y = w.axis == WaveAxis::y ? 0 : r.y;
        r.z = w.axis == WaveAxis::z ? 0 : r.z;
        n = length(r) * 20;
    }
    n += w.phase;
    if (w.distortion != 0) {
        NoiseParameters parameters;
        parameters.detail = w.detail;
        parameters.roughness = w.detail_roughness;
        parameters.before_4 = w.before_4;
        const Vec3f q = p * w.detail_scale;
        n += w.distortion * (fbm<3>({q.x, q.y, q.z}, parameters) * 2 - 1);
    }
    const float turns = n / (2 * kPi);
    switch (w.profile) {
    case WaveProfile::sine:
        return 0.5f + 0.5f * std::sin(n - kPi / 2);
    case WaveProfile::saw:
        return turns - std::floor(turns);
    case WaveProfile::triangle:
        return std::abs(turns - std::floor(turns + 0.5f)) * 2;
    }
    return 0;
}

/// 1 in the cells of the first colour. p: already scaled.
inline float checker(const Vec3f &at) {
    const Vec3f p = off_the_grid(at);
    const auto odd = [](float x) { return std::fmod(std::abs(std::floor(x)), 2.0f) == 1; };
    return (odd(p.x) == odd(p.y)) == odd(p.z) ? 1.0f : 0.0f;
}

enum class GradientKind : uint8_t { linear, quadratic, easing, diagonal, spherical, quadratic_sphere, radial };

inline float unclamped_gradient(GradientKind kind, const Vec3f &p) {
    const float sphere = std::max(0.999999f - length(p), 0.0f);
    switch (kind) {
    case GradientKind::linear:
        return p.x;
    case GradientKind::quadratic: {
        const float r = std::max(p.x, 0.0f);
        return r * r;
    }
    case GradientKind::easing: {
        const float r = std::clamp(p.x, 0.0f, 1.0f);
        return r * r * (3 - 2 * r);
    }
    case GradientKind::diagonal:
        return (p.x + p.y) * 0.5f;
    case GradientKind::radial:
        return std::atan2(p.y, p.x) / (2 * kPi) + 0.5f;
    case GradientKind::quadratic_sphere:
        return sphere * sphere;
    case GradientKind::spherical:
        return sphere;
    }
    return 0;
}

inline float gradient(GradientKind kind, const Vec3f &p) {
    return std::clamp(unclamped_gradient(kind, p), 0.0f, 1.0f);
}

/// A colour of sines of sums, `depth` times folded.
inline Vec3f magic(const Vec3f &at, float scale, float distortion, int depth) {
    const Vec3f p = each(at, [](float v) { return std::fmod(v, 2 * kPi); }) * (5 * scale);
    float x = std::sin(p.x + p.y + p.z), y = std::cos(-p.x + p.y - p.z), z = -std::cos(-p.x - p.y + p.z);
    if (depth > 0) {
        x *= distortion;
        y *= distortion;
        z *= distortion;
        // Each fold replaces one of the three by a sine or cosine of a signed sum of all.
        y = -std::cos(x - y + z) * distortion;
        if (depth > 1)
            x = std::cos(x - y - z) * distortion;
        if (depth > 2)
            z = std::sin(-x - y - z) * distortion;
        if (depth > 3)
            x = -std::cos(-x + y - z) * distortion;
        if (depth > 4)
            y = -std::sin(-x + y + z) * distortion;
        if (depth > 5)
            y = -std::cos(-x + y + z) * distortion;
        if (depth > 6)
            x = std::cos(x + y + z) * distortion;
        if (depth > 7)
            z = std::sin(x + y - z) * distortion;
        if (depth > 8)
            x = -std::cos(-x - y + z) * distortion;
        if (depth > 9)
            y = -std::sin(x - y + z) * distortion;
    }
    const float divisor = distortion != 0 ? 2 * distortion : 1;
    return {0.5f - x / divisor, 0.5f - y / divisor, 0.5f - z / divisor};
}

struct BrickParameters {
    float mortar_size, mortar_smooth, bias, width, row_height, offset, squash;
    int offset_frequency, squash_frequency;
};

/// A brick's own number in [0, 1].
inline float brick_tint(uint32_t n) {
    n = (n + 1013) & 0x7fffffff;
    n ^= n >> 13;
    const uint32_t stirred = (n * (n * n * 60493 + 19990303) + 1376312589) & 0x7fffffff;
    return 0.5f * (float(stirred) / 1073741824.0f);
}

/// (the tint between both colours, how much of the place is mortar, 0). p: already scaled.
inline Vec3f brick(const Vec3f &p, const BrickParameters &b) {
    const auto whole = [](float x) { return std::abs(x) < 2e9f ? int(std::floor(x)) : 0; };
    const int row = whole(p.y / b.row_height);
    float width = b.width, offset = 0;
    if (b.offset_frequency && b.squash_frequency) {
        width *= row % b.squash_frequency ? 1.0f : b.squash;
        offset = row % b.offset_frequency ? 0.0f : width * b.offset;
    }
    const int column = whole((p.x + offset) / width);
    const float x = p.x + offset - width * float(column), y = p.y - b.row_height * float(row);
    const float tint = std::clamp(brick_tint((uint32_t(row) << 16) + (uint32_t(column) & 0xffff)) + b.bias, 0.0f, 1.0f);
    const float inside = std::min(std::min(x, y), std::min(width - x, b.row_height - y));
    float mortar = 0;
    if (inside < b.mortar_size) {
        mortar = 1;
        if (b.mortar_smooth != 0) {
            const float t = std::clamp((1 - inside / b.mortar_size) / b.mortar_smooth, 0.0f, 1.0f);
            mortar = t * t * (3 - 2 * t);
        }
    }
    return {tint, mortar, 0};
}

} // namespace glimmer::nodes
