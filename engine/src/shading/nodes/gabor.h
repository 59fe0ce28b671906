// SPDX-License-Identifier: GPL-3.0-or-later
// Gabor noise by sparse convolution: Lagae, Lefebvre, Drettakis and Dutre 2009 ("Procedural noise using sparse Gabor
// convolution"), with a fixed number of impulses a cell and signs for weights (Tavernier, Neyret, Vergne and Thollot
// 2019), as a phasor (Tricard et al. 2019, "Procedural phasor noise"), as Blender has it from 4.3 on.
#pragma once

#include "shading/nodes/hash.h"
#include "shading/nodes/vector_math.h"

#include <cmath>

namespace glimmer::nodes {

enum class GaborOutput : uint8_t { value, phase, intensity };

namespace gabor_detail {

constexpr int kImpulses = 8; // of a cell

struct Phasor {
    float real = 0, imaginary = 0;
};

/// The kernel: a Gaussian within a Hann window, over a wave. It ends at distance 1.
inline Phasor kernel(float distance_squared, float turns) {
    const float envelope = std::exp(-kPi * distance_squared) * (0.5f + 0.5f * std::cos(kPi * distance_squared));
    const float angle = 2 * kPi * turns;
    return {envelope * std::cos(angle), envelope * std::sin(angle)};
}

inline Vec3f turned(const Vec3f &direction, float isotropy, const Point<4> &seed) {
    if (isotropy == 0)
        return direction;
    const float across = std::sqrt(direction.x * direction.x + direction.y * direction.y);
    const float cosine = across > 0 ? std::clamp(direction.x / across, -1.0f, 1.0f) : 1.0f;
    const float inclination = std::acos(std::clamp(direction.z, -1.0f, 1.0f)) +
                              hash_floats(seed[0], seed[1], seed[2], seed[3]) * kPi * isotropy;
    const float azimuth = (direction.y < 0 ? -std::acos(cosine) : std::acos(cosine)) +
                          hash_floats(seed[2], seed[0], seed[3], seed[1]) * kPi * isotropy;
    return {std::sin(inclination) * std::cos(azimuth), std::sin(inclination) * std::sin(azimuth),
            std::cos(inclination)};
}

inline void add_cell_2d(Phasor &sum, const Vec3f &cell, const Vec3f &p, float frequency, float isotropy, float angle) {
    for (int k = 0; k < kImpulses; ++k) {
        const auto first = float(3 * k);
        const float x = p.x - hash_floats(cell.x, cell.y, first + 1), y = p.y - hash_floats(first + 1, cell.x, cell.y);
        const float d2 = x * x + y * y;
        if (d2 >= 1)
            continue;
        const float orientation = angle + (hash_floats(cell.x, cell.y, first) - 0.5f) * kPi * isotropy;
        const float sign = hash_floats(cell.x, cell.y, first + 2) < 0.5f ? -1.0f : 1.0f;
        const Phasor one = kernel(d2, frequency * (x * std::cos(orientation) + y * std::sin(orientation)));
        sum.real += sign * one.real;
        sum.imaginary += sign * one.imaginary;
    }
}

inline void add_cell_3d(Phasor &sum, const Vec3f &cell, const Vec3f &p, float frequency, float isotropy,
                        const Vec3f &direction) {
    for (int k = 0; k < kImpulses; ++k) {
        const auto first = float(3 * k);
        const Vec3f way = p - hash_color(Point<4>{cell.x, cell.y, cell.z, first + 1});
        const float d2 = length_squared(way);
        if (d2 >= 1)
            continue;
        const Vec3f along = turned(direction, isotropy, {cell.x, cell.y, cell.z, first});
        const float sign = hash_floats(cell.x, cell.y, cell.z, first + 2) < 0.5f ? -1.0f : 1.0f;
        const Phasor one = kernel(d2, frequency * dot(way, along));
        sum.real += sign * one.real;
        sum.imaginary += sign * one.imaginary;
    }
}

} // namespace gabor_detail

/// orientation: its x an angle in 2D, a direction in 3D.
inline float gabor(GaborOutput output, bool three, const Vec3f &at, float scale, float frequency, float anisotropy,
                   const Vec3f &orientation) {
    using namespace gabor_detail;
    const Vec3f p = at * scale;
    const float isotropy = 1 - std::clamp(anisotropy, 0.0f, 1.0f), waves = std::max(frequency, 0.001f);
    const Vec3f cell{std::floor(p.x), std::floor(p.y), std::floor(p.z)}, rest = p - cell;
    const Vec3f direction = safe_normalize(orientation);
    Phasor sum;
    for (int k = three ? -1 : 0; k <= (three ? 1 : 0); ++k)
        for (int j = -1; j <= 1; ++j)
            for (int i = -1; i <= 1; ++i) {
                const Vec3f offset{float(i), float(j), float(k)};
                if (three)
                    add_cell_3d(sum, cell + offset, rest - offset, waves, isotropy, direction);
                else
                    add_cell_2d(sum, cell + offset, rest - offset, waves, isotropy, orientation.x);
            }
    // The noise's standard deviation (Lagae et al., eq. 9, of high frequencies; half of the weights' square), of which
    // six make the range.
    const float of_kernel = three ? 1 / (4 * std::sqrt(2.0f)) : 0.25f;
    const float range = 6 * std::sqrt(float(kImpulses) * 0.5f * of_kernel);
    switch (output) {
    case GaborOutput::value:
        return sum.imaginary / range * 0.5f + 0.5f;
    case GaborOutput::phase:
        return (std::atan2(sum.imaginary, sum.real) + kPi) / (2 * kPi);
    case GaborOutput::intensity:
        break;
    }
    return std::sqrt(sum.real * sum.real + sum.imaginary * sum.imaginary) / range;
}

} // namespace glimmer::nodes
