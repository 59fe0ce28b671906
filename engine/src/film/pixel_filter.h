// SPDX-License-Identifier: GPL-3.0-or-later
// The filter of a pixel: how much each place of the film around its middle counts for it. Separable, never negative.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace glimmer {

class PixelFilter {
  public:
    /// A box as wide as the pixel.
    PixelFilter() = default;
    /// The Blackman-Harris window. width: of all that counts, in pixels, above 0.
    static PixelFilter blackman_harris(float width);

    float width() const { return width_; } ///< pixels

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
