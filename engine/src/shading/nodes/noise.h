// SPDX-License-Identifier: GPL-3.0-or-later
// Perlin noise in one to four dimensions (Perlin, Improving Noise, 2002) and the fractals made of it (Musgrave, in
// Texturing and Modeling), with the lattice hash, scales and octaves of Blender's Noise and Musgrave nodes.
#pragma once

#include "shading/nodes/hash.h"

#include <algorithm>
#include <cmath>

namespace glimmer::nodes {

template <size_t N>
Point<N> operator*(const Point<N> &p, float s) {
    Point<N> out{};
    for (size_t i = 0; i < N; ++i)
        out[i] = p[i] * s;
    return out;
}
template <size_t N>
Point<N> operator+(const Point<N> &a, const Point<N> &b) {
    Point<N> out{};
    for (size_t i = 0; i < N; ++i)
        out[i] = a[i] + b[i];
    return out;
}

/// A float's cell and the rest. What is not finite or beyond the integers lies in cell 0.
struct Cell {
    explicit Cell(float x) {
        const float low = std::floor(x);
        const bool usable = std::abs(low) < 2147483000.0f;
        index = usable ? int32_t(low) : 0;
        rest = usable ? x - low : 0.0f;
    }
    int32_t index;
    float rest;
};

inline float quintic_fade(float t) {
    return t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f);
}

/// The dot product of a lattice point's gradient with the way from it.
template <size_t N>
float lattice_gradient(uint32_t hash, const Point<N> &d) {
    const auto signed_by = [hash](float v, uint32_t bit) { return hash & bit ? -v : v; };
    if constexpr (N == 1) {
        return signed_by(float(1 + (hash & 7)), 8) * d[0];
    } else if constexpr (N == 2) {
        const bool first = (hash & 7) < 4;
        return signed_by(first ? d[0] : d[1], 1) + signed_by(2.0f * (first ? d[1] : d[0]), 2);
    } else if constexpr (N == 3) {
        const uint32_t h = hash & 15;
        const float u = h < 8 ? d[0] : d[1];
        const float v = h < 4 ? d[1] : h == 12 || h == 14 ? d[0] : d[2];
        return signed_by(u, 1) + signed_by(v, 2);
    } else {
        const uint32_t h = hash & 31;
        const float u = h < 24 ? d[0] : d[1], v = h < 16 ? d[1] : d[2], s = h < 8 ? d[2] : d[3];
        return signed_by(u, 1) + signed_by(v, 2) + signed_by(s, 4);
    }
}

/// In [-1, 1] or nearly.
template <size_t N>
float perlin(const Point<N> &p) {
    constexpr float kScale[] = {0.25f, 0.6616f, 0.9820f, 0.8344f};
    std::array<int32_t, N> cell{};
    Point<N> rest{}, fade{};
    for (size_t i = 0; i < N; ++i) {
        const Cell c(p[i]);
        cell[i] = c.index;
        rest[i] = c.rest;
        fade[i] = quintic_fade(c.rest);
    }
    constexpr size_t kCorners = size_t(1) << N;
    std::array<float, kCorners> value{};
    for (size_t corner = 0; corner < kCorners; ++corner) {
        std::array<uint32_t, N> at{};
        Point<N> d{};
        for (size_t i = 0; i < N; ++i) {
            const uint32_t bit = corner >> i & 1;
            at[i] = uint32_t(cell[i]) + bit;
            d[i] = rest[i] - float(bit);
        }
        value[corner] = lattice_gradient<N>(hash_words(at), d);
    }
    for (size_t i = 0; i < N; ++i)
        for (size_t k = 0; k < kCorners >> (i + 1); ++k)
            value[k] = value[2 * k] + fade[i] * (value[2 * k + 1] - value[2 * k]);
    return value[0] * kScale[N - 1];
}

/// Signed noise of a point as from Blender 4.0: far from the origin the coordinates are wrapped, so that floats still
/// tell neighbours apart.
template <size_t N>
float wrapped_perlin(const Point<N> &p) {
    Point<N> q{};
    for (size_t i = 0; i < N; ++i) {
        const float beyond = std::abs(p[i]) >= 1e6f ? 0.5f : 0.0f;
        q[i] = std::fmod(p[i], 1e5f) + beyond;
    }
    return perlin<N>(q);
}

/// Where the further channels of a noise are taken, in [100, 200).
template <size_t N>
Point<N> channel_offset(float channel) {
    Point<N> out{};
    for (size_t i = 0; i < N; ++i)
        out[i] = 100.0f + 100.0f * (N == 1 ? hash_floats(channel) : hash_floats(channel, float(i)));
    return out;
}

enum class NoiseKind : uint8_t { fbm, multifractal, hybrid, ridged, hetero };

struct NoiseParameters {
    float detail = 2, roughness = 0.5f, lacunarity = 2, offset = 0, gain = 1, distortion = 0;
    NoiseKind kind = NoiseKind::fbm;
    bool normalized = true;
    bool before_4 = false; ///< Blender's before 4.0: every octave in [0, 1], coordinates as they come
};

inline constexpr float kMostOctaves = 15;

template <size_t N>
float octave(const Point<N> &p, bool before_4) {
    return before_4 ? perlin<N>(p) : wrapped_perlin<N>(p);
}

/// The sum of octaves; a part of an octave is blended in.
template <size_t N>
float fbm(const Point<N> &p, const NoiseParameters &n) {
    const float detail = std::clamp(n.detail, 0.0f, kMostOctaves);
    const int whole = int(detail);
    const float part = detail - float(whole);
    const float falloff = n.before_4 ? std::clamp(n.roughness, 0.0f, 1.0f) : std::max(n.roughness, 0.0f);
    float sum = 0, most = 0, amplitude = 1, frequency = 1;
    const auto value = [&](float total, float scale) { return n.normalized ? 0.5f * total / scale + 0.5f : total; };
    for (int i = 0; i <= whole; ++i) {
        sum += octave<N>(p * frequency, n.before_4) * amplitude;
        most += amplitude;
        amplitude *= falloff;
        frequency *= n.lacunarity;
    }
    if (part == 0)
        return value(sum, most);
    const float further = sum + octave<N>(p * frequency, n.before_4) * amplitude;
    return (1 - part) * value(sum, most) + part * value(further, most + amplitude);
}

/// Musgrave's fractals, `octaves` of them with a part of one more. `start`: the amplitude of the first octave after
/// those that a kind always has.
template <size_t N>
float multifractal(Point<N> p, float octaves, float falloff, const NoiseParameters &n) {
    const int whole = int(octaves);
    float value = 1, power = 1;
    for (int i = 0; i < whole; ++i) {
        value *= power * octave<N>(p, n.before_4) + 1;
        power *= falloff;
        p = p * n.lacunarity;
    }
    const float part = octaves - float(whole);
    return part == 0 ? value : value * (part * power * octave<N>(p, n.before_4) + 1);
}

template <size_t N>
float hetero_terrain(Point<N> p, float octaves, float falloff, const NoiseParameters &n) {
    const int whole = int(octaves);
    float power = falloff;
    float value = n.offset + octave<N>(p, n.before_4);
    p = p * n.lacunarity;
    for (int i = 1; i < whole; ++i) {
        value += (octave<N>(p, n.before_4) + n.offset) * power * value;
        power *= falloff;
        p = p * n.lacunarity;
    }
    const float part = octaves - float(whole);
    return part == 0 ? value : value + part * (octave<N>(p, n.before_4) + n.offset) * power * value;
}

template <size_t N>
float hybrid_multifractal(Point<N> p, float octaves, float falloff, const NoiseParameters &n) {
    const int whole = int(octaves);
    float power = 1, value = 0, weight = 1;
    for (int i = 0; i < whole && weight > 0.001f; ++i) {
        weight = std::min(weight, 1.0f);
        const float signal = (octave<N>(p, n.before_4) + n.offset) * power;
        power *= falloff;
        value += weight * signal;
        weight *= n.gain * signal;
        p = p * n.lacunarity;
    }
    const float part = octaves - float(whole);
    if (part == 0 || !(weight > 0.001f))
        return value;
    weight = std::min(weight, 1.0f);
    return value + part * weight * (octave<N>(p, n.before_4) + n.offset) * power;
}

template <size_t N>
float ridged_multifractal(Point<N> p, float octaves, float falloff, const NoiseParameters &n) {
    const auto ridge = [&n](const Point<N> &q) {
        const float signal = n.offset - std::abs(octave<N>(q, n.before_4));
        return signal * signal;
    };
    const int whole = int(octaves);
    float power = falloff, signal = ridge(p);
    float value = signal;
    for (int i = 1; i < whole; ++i) {
        p = p * n.lacunarity;
        const float weight = std::clamp(signal * n.gain, 0.0f, 1.0f);
        signal = weight * ridge(p);
        value += signal * power;
        power *= falloff;
    }
    return value;
}

/// All kinds but fbm, which differs by the version of the node.
template <size_t N>
float rough_fractal(const Point<N> &p, float octaves, float falloff, const NoiseParameters &n) {
    switch (n.kind) {
    case NoiseKind::multifractal:
        return multifractal<N>(p, octaves, falloff, n);
    case NoiseKind::hybrid:
        return hybrid_multifractal<N>(p, octaves, falloff, n);
    case NoiseKind::ridged:
        return ridged_multifractal<N>(p, octaves, falloff, n);
    case NoiseKind::hetero:
        return hetero_terrain<N>(p, octaves, falloff, n);
    case NoiseKind::fbm:
        break;
    }
    return 0;
}

template <size_t N>
float fractal(const Point<N> &p, const NoiseParameters &n) {
    const float octaves = std::clamp(n.detail, 0.0f, kMostOctaves) + 1, falloff = std::max(n.roughness, 0.0f);
    if (n.kind != NoiseKind::fbm)
        return rough_fractal<N>(p, octaves, falloff, n);
    return fbm<N>(p, n);
}

template <size_t N>
Point<N> distorted(Point<N> p, const NoiseParameters &n) {
    if (n.distortion == 0)
        return p;
    Point<N> shift{};
    for (size_t i = 0; i < N; ++i)
        shift[i] = octave<N>(p + channel_offset<N>(float(i)), n.before_4) * n.distortion;
    return p + shift;
}

template <size_t N>
float noise(const Point<N> &p, const NoiseParameters &n) {
    return fractal<N>(distorted<N>(p, n), n);
}

/// The node's colour; its first channel is its value.
template <size_t N>
Vec3f noise_color(const Point<N> &p, const NoiseParameters &n) {
    const Point<N> q = distorted<N>(p, n);
    return {fractal<N>(q, n), fractal<N>(q + channel_offset<N>(float(N)), n),
            fractal<N>(q + channel_offset<N>(float(N + 1)), n)};
}

/// Blender's Musgrave node, before 4.1: each octave weighs lacunarity^-dimension of the one before.
template <size_t N>
float musgrave(const Point<N> &p, float dimension, NoiseParameters n) {
    n.before_4 = true;
    n.lacunarity = std::max(n.lacunarity, 1e-5f);
    const float falloff = std::pow(n.lacunarity, -std::max(dimension, 1e-5f));
    const float octaves = std::clamp(n.detail, 0.0f, kMostOctaves);
    if (n.kind != NoiseKind::fbm)
        return rough_fractal<N>(p, octaves, falloff, n);
    const int whole = int(octaves);
    float value = 0, power = 1;
    Point<N> q = p;
    for (int i = 0; i < whole; ++i) {
        value += perlin<N>(q) * power;
        power *= falloff;
        q = q * n.lacunarity;
    }
    const float part = octaves - float(whole);
    return part == 0 ? value : value + part * perlin<N>(q) * power;
}

} // namespace glimmer::nodes
