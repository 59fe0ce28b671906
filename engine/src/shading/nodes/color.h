// SPDX-License-Identifier: GPL-3.0-or-later
// Colours: blend modes, HSV and HSL, and the small colour nodes of Blender. Channels are plain numbers, without bounds.
#pragma once

#include "shading/nodes/vector_math.h"

namespace glimmer::nodes {

inline float luminance(const Vec3f &c) {
    return 0.2126729f * c.x + 0.7151522f * c.y + 0.0721750f * c.z;
}
inline float average(const Vec3f &c) {
    return (c.x + c.y + c.z) * (1.0f / 3.0f);
}

inline float unit(float x) {
    return std::clamp(x, 0.0f, 1.0f);
}
inline Vec3f unit(const Vec3f &c) {
    return {unit(c.x), unit(c.y), unit(c.z)};
}

inline Vec3f lerp(const Vec3f &a, const Vec3f &b, float t) {
    return a * (1 - t) + b * t;
}

/// Hue, saturation and value, in sixths of a turn divided by six.
inline Vec3f rgb_to_hsv(const Vec3f &c) {
    const float most = std::max({c.x, c.y, c.z}), least = std::min({c.x, c.y, c.z}), range = most - least;
    const float saturation = most != 0 ? range / most : 0.0f;
    if (saturation == 0)
        return {0, 0, most};
    const float r = (most - c.x) / range, g = (most - c.y) / range, b = (most - c.z) / range;
    float hue = c.x == most ? b - g : c.y == most ? 2 + r - b : 4 + g - r;
    hue /= 6;
    return {hue < 0 ? hue + 1 : hue, saturation, most};
}

inline Vec3f hsv_to_rgb(const Vec3f &hsv) {
    if (hsv.y == 0)
        return {hsv.z, hsv.z, hsv.z};
    const float hue = (hsv.x == 1 ? 0.0f : hsv.x) * 6, sector = std::floor(hue), f = hue - sector;
    const float v = hsv.z, p = v * (1 - hsv.y), q = v * (1 - hsv.y * f), t = v * (1 - hsv.y * (1 - f));
    switch (std::isfinite(sector) ? int(std::clamp(sector, -1.0f, 6.0f)) : -1) {
    case 0:
        return {v, t, p};
    case 1:
        return {q, v, p};
    case 2:
        return {p, v, t};
    case 3:
        return {p, q, v};
    case 4:
        return {t, p, v};
    default:
        return {v, p, q};
    }
}

inline Vec3f rgb_to_hsl(const Vec3f &c) {
    const float most = std::max({c.x, c.y, c.z}), least = std::min({c.x, c.y, c.z}), range = most - least;
    const float light = std::min(1.0f, (most + least) / 2);
    if (range == 0)
        return {0, 0, light};
    const float saturation = light > 0.5f ? range / (2 - most - least) : range / (most + least);
    float hue = most == c.x   ? (c.y - c.z) / range + (c.y < c.z ? 6.0f : 0.0f)
                : most == c.y ? (c.z - c.x) / range + 2
                              : (c.x - c.y) / range + 4;
    return {hue / 6, saturation, light};
}

inline Vec3f hsl_to_rgb(const Vec3f &hsl) {
    const auto ramp = [](float x) { return std::clamp(x, 0.0f, 1.0f); };
    const Vec3f n{ramp(std::abs(hsl.x * 6 - 3) - 1), ramp(2 - std::abs(hsl.x * 6 - 2)),
                  ramp(2 - std::abs(hsl.x * 6 - 4))};
    const float chroma = (1 - std::abs(2 * hsl.z - 1)) * hsl.y;
    return each(n, [&](float x) { return (x - 0.5f) * chroma + hsl.z; });
}

enum class ConvertKind : uint8_t { rgb_to_hsv, hsv_to_rgb, rgb_to_hsl, hsl_to_rgb };

inline Vec3f convert(ConvertKind kind, const Vec3f &c) {
    switch (kind) {
    case ConvertKind::rgb_to_hsv:
        return rgb_to_hsv(c);
    case ConvertKind::hsv_to_rgb:
        return hsv_to_rgb(c);
    case ConvertKind::rgb_to_hsl:
        return rgb_to_hsl(c);
    case ConvertKind::hsl_to_rgb:
        return hsl_to_rgb(c);
    }
    return c;
}

/// In the order of the op table (shading/ops.h).
enum class BlendKind : uint8_t {
    mix,
    darken,
    multiply,
    burn,
    lighten,
    screen,
    dodge,
    add,
    overlay,
    soft_light,
    linear_light,
    difference,
    exclusion,
    subtract,
    divide,
    hue,
    saturation,
    color,
    value
};

/// One channel of the modes that keep channels apart, the factor included.
inline float blend_channel(BlendKind kind, float a, float b, float t) {
    const float rest = 1 - t;
    switch (kind) {
    case BlendKind::darken:
        return std::min(a, b) * t + a * rest;
    case BlendKind::multiply:
        return a * rest + a * b * t;
    case BlendKind::lighten:
        return std::max(a, b) * t + a * rest;
    case BlendKind::screen:
        return 1 - (rest + t * (1 - b)) * (1 - a);
    case BlendKind::add:
        return a + t * b;
    case BlendKind::subtract:
        return a - t * b;
    case BlendKind::difference:
        return a * rest + t * std::abs(a - b);
    case BlendKind::exclusion:
        return std::max(a * rest + t * (a + b - 2 * a * b), 0.0f);
    case BlendKind::divide:
        return b != 0 ? a * rest + t * a / b : a;
    case BlendKind::linear_light:
        return a + t * (b > 0.5f ? 2 * (b - 0.5f) : 2 * b - 1);
    case BlendKind::overlay:
        return a < 0.5f ? a * (rest + 2 * t * b) : 1 - (rest + 2 * t * (1 - b)) * (1 - a);
    case BlendKind::soft_light:
        return rest * a + t * ((1 - a) * b * a + a * (1 - (1 - b) * (1 - a)));
    case BlendKind::dodge: {
        if (a == 0)
            return a;
        const float below = 1 - t * b;
        return below <= 0 ? 1.0f : std::min(a / below, 1.0f);
    }
    case BlendKind::burn: {
        const float below = rest + t * b;
        return below <= 0 ? 0.0f : std::clamp(1 - (1 - a) / below, 0.0f, 1.0f);
    }
    default:
        return a * rest + b * t;
    }
}

inline Vec3f blend(BlendKind kind, float t, const Vec3f &a, const Vec3f &b) {
    switch (kind) {
    case BlendKind::hue: {
        const Vec3f other = rgb_to_hsv(b);
        if (other.y == 0)
            return a;
        const Vec3f own = rgb_to_hsv(a);
        return lerp(a, hsv_to_rgb({other.x, own.y, own.z}), t);
    }
    case BlendKind::saturation: {
        const Vec3f own = rgb_to_hsv(a);
        return own.y == 0 ? a : hsv_to_rgb({own.x, (1 - t) * own.y + t * rgb_to_hsv(b).y, own.z});
    }
    case BlendKind::color: {
        const Vec3f other = rgb_to_hsv(b);
        return other.y == 0 ? a : lerp(a, hsv_to_rgb({other.x, other.y, rgb_to_hsv(a).z}), t);
    }
    case BlendKind::value: {
        const Vec3f own = rgb_to_hsv(a);
        return hsv_to_rgb({own.x, own.y, (1 - t) * own.z + t * rgb_to_hsv(b).z});
    }
    default:
        return {blend_channel(kind, a.x, b.x, t), blend_channel(kind, a.y, b.y, t), blend_channel(kind, a.z, b.z, t)};
    }
}

/// The Hue/Saturation/Value node: 0.5, 1, 1 change nothing.
inline Vec3f hue_saturation(float hue, float saturation, float value, float t, const Vec3f &c) {
    Vec3f hsv = rgb_to_hsv(c);
    const float turned = hsv.x + hue + 0.5f;
    hsv = {turned - std::floor(turned), unit(hsv.y * saturation), hsv.z * value};
    const Vec3f out = lerp(c, hsv_to_rgb(hsv), t);
    return each(out, [](float x) { return std::max(x, 0.0f); });
}

inline Vec3f bright_contrast(const Vec3f &c, float bright, float contrast) {
    return each(c, [&](float x) { return std::max((1 + contrast) * x + bright - contrast * 0.5f, 0.0f); });
}

inline Vec3f gamma(const Vec3f &c, float exponent) {
    return each(c, [&](float x) { return exponent == 0 ? 1.0f : x > 0 ? std::pow(x, exponent) : x; });
}

inline Vec3f invert(float t, const Vec3f &c) {
    return each(c, [&](float x) { return t * (1 - x) + (1 - t) * x; });
}

} // namespace glimmer::nodes
