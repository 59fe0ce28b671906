// SPDX-License-Identifier: GPL-3.0-or-later
// The sky all around: a constant or an equirectangular picture.
#pragma once

#include "light/interface.h"
#include "light/varying_emission.h"
#include "sampling/distribution_2d.h"
#include "sampling/warp.h"
#include "shading/arrival.h"

#include <array>
#include <cmath>
#include <vector>

namespace glimmer {

struct EnvironmentLight {
    Rgb color;
    std::vector<Rgb> pixels; ///< top row first; empty: constant
    uint32_t width = 0, height = 0;
    Distribution2d distribution;              ///< empty: constant
    std::array<Vec3f, 3> to_local;            ///< rows
    Rgb mean;                                 ///< over the sphere of directions
    const VaryingEmission *varying = nullptr; ///< gives the radiance itself; `pixels` are only what is sampled by

    static constexpr LightTraits traits{.infinite = true, .camera_visible = true};

    Vec3f local(const Vec3f &direction) const {
        return {dot(to_local[0], direction), dot(to_local[1], direction), dot(to_local[2], direction)};
    }
};

/// Where a direction stands in an equirectangular picture: centre along +y, z up; u to the right, v down, both 0 to 1.
inline Vec2f equirectangular(const Vec3f &d) {
    const float u = 0.5f + std::atan2(d.x, d.y) / (2 * kPi);
    const float v = std::atan2(std::hypot(d.x, d.y), d.z) / kPi;
    return {u, v};
}

/// Bilinear between texel centres; wraps around, and stops at the poles.
inline Rgb radiance_at_infinity(const EnvironmentLight &light, const Vec3f &direction, uint8_t ray) {
    if (light.varying)
        return light.varying->of_sky(direction, ray, ray & kCameraRay);
    if (light.pixels.empty())
        return light.color;
    const uint32_t width = light.width, height = light.height;
    const Vec2f uv = equirectangular(light.local(direction));
    const float px = uv.x * float(width) - 0.5f, py = std::clamp(uv.y * float(height) - 0.5f, 0.0f, float(height - 1));
    const float fx = px - std::floor(px), fy = py - std::floor(py);
    const auto column = [&](float x) { return size_t((int64_t(x) + int64_t(width)) % int64_t(width)); };
    const size_t x0 = column(std::floor(px)), x1 = column(std::floor(px) + 1);
    const auto y0 = size_t(py), y1 = std::min(y0 + 1, size_t(height - 1));
    const Rgb top = light.pixels[y0 * width + x0] * (1 - fx) + light.pixels[y0 * width + x1] * fx;
    const Rgb bottom = light.pixels[y1 * width + x0] * (1 - fx) + light.pixels[y1 * width + x1] * fx;
    return (top * (1 - fy) + bottom * fy) * light.color;
}

inline std::optional<LightSample> sample(const EnvironmentLight &light, const Vec3f &, Vec2f u) {
    Vec3f local;
    float pdf;
    if (light.distribution.empty()) {
        local = sample_uniform_sphere(u);
        pdf = pdf_uniform_sphere();
    } else {
        const Distribution2dSample s = light.distribution.sample(u);
        const float phi = (s.uv.x - 0.5f) * 2 * kPi, theta = s.uv.y * kPi, sine = std::sin(theta);
        local = {sine * std::sin(phi), sine * std::cos(phi), std::cos(theta)};
        if (!(sine > 0))
            return std::nullopt;
        pdf = s.pdf / (2 * kPi * kPi * sine);
    }
    const Vec3f direction = light.to_local[0] * local.x + light.to_local[1] * local.y + light.to_local[2] * local.z;
    return LightSample{direction, kInfinity, radiance_at_infinity(light, direction, kFromDiffuse.flags), pdf, false};
}

inline float pdf(const EnvironmentLight &light, const Vec3f &, const Vec3f &direction, const LightHit &) {
    if (light.distribution.empty())
        return pdf_uniform_sphere();
    const Vec3f local = light.local(direction);
    const float sine = std::hypot(local.x, local.y);
    return sine > 0 ? light.distribution.pdf(equirectangular(local)) / (2 * kPi * kPi * sine) : 0.0f;
}

inline LightBound bound(const EnvironmentLight &light) {
    return {.infinite = true, .strength = kPi * mean_component(light.mean)};
}

} // namespace glimmer
