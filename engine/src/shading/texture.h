// SPDX-License-Identifier: GPL-3.0-or-later
// An image that programs look up: 8-bit or float texels as they were handed in, filtered as stored and made linear
// afterwards, as Blender does.
#pragma once

#include "math/vec.h"

#include <array>
#include <cstdint>
#include <vector>

namespace glimmer {

struct Texel {
    float r = 0, g = 0, b = 0, a = 1;

    friend Texel operator+(const Texel &p, const Texel &q) { return {p.r + q.r, p.g + q.g, p.b + q.b, p.a + q.a}; }
    friend Texel operator*(const Texel &p, float s) { return {p.r * s, p.g * s, p.b * s, p.a * s}; }
};

enum class Interpolation : uint8_t { linear, closest, cubic };
enum class Extension : uint8_t { repeat, extend, clip, mirror };

class Texture {
  public:
    uint32_t width = 1, height = 1, channels = 4;
    bool srgb = false;          ///< texels are encoded as sRGB
    std::vector<uint8_t> bytes; ///< (height, width, channels), bottom row first; or else:
    std::vector<float> floats;

    size_t size() const { return bytes.size() + floats.size() * sizeof(float); }

    /// At u, v in [0, 1] from the bottom left corner to the top right one. straight: colours are divided by their
    /// alpha, by which they come multiplied.
    Texel lookup(float u, float v, Interpolation interpolation, Extension extension, bool straight) const;

  private:
    Texel texel(size_t x, size_t y) const;
    Texel fetch(int64_t x, int64_t y, Extension extension) const;
    Texel filtered(float u, float v, Interpolation interpolation, Extension extension) const;
};

/// The inverse of sRGB's transfer function (IEC 61966-2-1); what is below 0 becomes 0.
float srgb_to_linear(float c);

} // namespace glimmer
