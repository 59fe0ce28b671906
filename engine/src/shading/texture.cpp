// SPDX-License-Identifier: GPL-3.0-or-later
#include "shading/texture.h"

#include <cmath>

namespace glimmer {

namespace {

/// Where a coordinate beyond the image lies in it; -1: nowhere.
int64_t placed(int64_t i, int64_t size, Extension extension) {
    if (i >= 0 && i < size)
        return i;
    switch (extension) {
    case Extension::repeat: {
        const int64_t rest = i % size;
        return rest < 0 ? rest + size : rest;
    }
    case Extension::extend:
        return i < 0 ? 0 : size - 1;
    case Extension::mirror: {
        int64_t rest = i % (2 * size);
        rest = rest < 0 ? rest + 2 * size : rest;
        return rest < size ? rest : 2 * size - 1 - rest;
    }
    case Extension::clip:
        break;
    }
    return -1;
}

/// The weights of a cubic B-spline, which blurs, at t in [0, 1] between the two texels in the middle.
std::array<float, 4> spline_weights(float t) {
    const float s = 1 - t, sixth = 1.0f / 6.0f;
    return {sixth * s * s * s, sixth * (3 * t * t * (t - 2) + 4), sixth * (3 * s * s * (s - 2) + 4), sixth * t * t * t};
}

struct Position {
    int64_t index;
    float rest;
};

Position position(float x) {
    const float low = std::floor(x);
    if (!(std::abs(low) < 4e18f))
        return {0, 0};
    return {int64_t(low), x - low};
}

} // namespace

float srgb_to_linear(float c) {
    if (c < 0.04045f)
        return c < 0 ? 0.0f : c * (1.0f / 12.92f);
    return std::pow((c + 0.055f) * (1.0f / 1.055f), 2.4f);
}

Texel Texture::texel(size_t x, size_t y) const {
    const size_t first = (y * width + x) * channels;
    const auto value = [&](size_t c) {
        return bytes.empty() ? floats[first + c] : float(bytes[first + c]) * (1.0f / 255.0f);
    };
    const float r = value(0);
    if (channels < 3)
        return {r, r, r, channels == 2 ? value(1) : 1.0f};
    return {r, value(1), value(2), channels == 4 ? value(3) : 1.0f};
}

Texel Texture::fetch(int64_t x, int64_t y, Extension extension) const {
    const int64_t px = placed(x, int64_t(width), extension), py = placed(y, int64_t(height), extension);
    return px < 0 || py < 0 ? Texel{0, 0, 0, 0} : texel(size_t(px), size_t(py));
}

Texel Texture::filtered(float u, float v, Interpolation interpolation, Extension extension) const {
    const float x = u * float(width), y = v * float(height);
    if (extension == Extension::clip && !(u >= 0 && u <= 1 && v >= 0 && v <= 1) &&
        interpolation == Interpolation::closest)
        return {0, 0, 0, 0};
    if (interpolation == Interpolation::closest)
        return fetch(position(x).index, position(y).index, extension);
    const Position px = position(x - 0.5f), py = position(y - 0.5f);
    if (interpolation == Interpolation::linear) {
        const auto row = [&](int64_t at) {
            return fetch(px.index, at, extension) * (1 - px.rest) + fetch(px.index + 1, at, extension) * px.rest;
        };
        return row(py.index) * (1 - py.rest) + row(py.index + 1) * py.rest;
    }
    const auto along = spline_weights(px.rest), across = spline_weights(py.rest);
    Texel sum{0, 0, 0, 0};
    for (size_t j = 0; j < 4; ++j)
        for (size_t i = 0; i < 4; ++i)
            sum = sum + fetch(px.index + int64_t(i) - 1, py.index + int64_t(j) - 1, extension) * (along[i] * across[j]);
    return sum;
}

Texel Texture::lookup(float u, float v, Interpolation interpolation, Extension extension, bool straight) const {
    Texel t = filtered(u, v, interpolation, extension);
    if (straight && t.a != 0 && t.a != 1) {
        t.r /= t.a;
        t.g /= t.a;
        t.b /= t.a;
    }
    if (srgb) {
        t.r = srgb_to_linear(t.r);
        t.g = srgb_to_linear(t.g);
        t.b = srgb_to_linear(t.b);
    }
    return t;
}

} // namespace glimmer
