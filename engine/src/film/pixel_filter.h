// SPDX-License-Identifier: GPL-3.0-or-later
// The filter of a pixel: how much each place of the film around its middle counts for it. Separable, never negative.
#pragma once

#include "math/vec.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace glimmer {

/// What a sample counts in each pixel around the one that it lies in: x[reach + i] y[reach + j] in the pixel i to the
/// right and j below. As it is made: 1 in its own alone.
struct FilterWeights {
    /// Filters that reach farther are not reconstructed with. Chosen: a sample is added to the squares of pixels.
    static constexpr uint32_t kMostReach = 2;

    uint32_t reach = 0;
    std::array<float, 2 * kMostReach + 1> x{1}, y{1};
};

class PixelFilter {
  public:
    /// A box as wide as the pixel.
    PixelFilter() = default;
    /// The Blackman-Harris window. width: of all that counts, in pixels, above 0.
    static PixelFilter blackman_harris(float width);

    float width() const { return width_; } ///< pixels
    /// How many pixels to each side of its own a sample may count for.
    uint32_t reach() const { return uint32_t(std::max(std::ceil(0.5f * width_ - 0.5f), 0.0f)); }

    // In one of the two dimensions, offsets in pixels from the middle of the pixel:

    /// The offset of a sample that is drawn in proportion to the filter (filter importance sampling: Ernst, Stamminger
    /// and Greiner 2006). u: uniform, in [0, 1).
    float sample(float u) const {
        if (inverse_.empty())
            return u - 0.5f;
        const float x = u * float(inverse_.size() - 1);
        const size_t i = x < float(inverse_.size() - 2) ? size_t(x) : inverse_.size() - 2;
        const float f = x - float(i);
        return (inverse_[i] * (1 - f) + inverse_[i + 1] * f) * width_;
    }
    /// The density of those offsets, per pixel; its integral is 1.
    float density(float offset) const {
        if (inverse_.empty())
            return offset >= -0.5f && offset < 0.5f ? 1.0f : 0.0f;
        const float x = offset / width_;
        if (!(x >= inverse_.front() && x < inverse_.back()))
            return 0;
        size_t i = first_above_[size_t((x - inverse_.front()) * float(first_above_.size() - 1))];
        while (inverse_[i] <= x)
            ++i;
        return density_[i];
    }

    // For samples that count for every pixel whose filter holds them (docs/method.md, section 18):

    /// The offset of a sample within a pixel, -0.5 to 0.5, drawn in proportion to the sum of what the filters of all
    /// pixels have there.
    float sample_folded(float u) const {
        const float offset = sample(u);
        return offset - std::floor(offset + 0.5f);
    }
    /// The filter of each pixel around over that sum, for a reach of kMostReach at most. They sum to 1, and so do those
    /// that one pixel has of samples at this offset in all pixels around it.
    FilterWeights weights(Vec2f folded) const;

  private:
    explicit PixelFilter(float width, std::vector<float> inverse);

    float width_ = 1;
    /// Inverse CDF over [0, 1] -> [-0.5, 0.5] of the width; empty: box. Samples fall evenly between its entries.
    std::vector<float> inverse_;
    std::vector<float> density_; ///< before each entry, from the one before it on; 0 before the first
    /// For equal parts of the width, the first entry that may be above an offset in there.
    std::vector<uint16_t> first_above_;
};

} // namespace glimmer
