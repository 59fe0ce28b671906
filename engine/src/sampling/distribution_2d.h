// SPDX-License-Identifier: GPL-3.0-or-later
// A piecewise constant density over the unit square, for environment images.
#pragma once

#include "math/vec.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace glimmer {

struct Distribution2dSample {
    Vec2f uv;
    float pdf; ///< per unit of uv area
};

/// Rows are drawn by their sums, then columns within a row, both by inversion, which keeps strata. Cumulative sums are
/// whole counts out of 2^24, the steps of a random float: so pdf() is exactly the probability with which sample() draws
/// a texel. Every texel of positive weight has at least one step in its row, every such row one step: none is lost
/// beside a sun.
class Distribution2d {
  public:
    Distribution2d() = default;
    /// weights: (height, width), finite, >= 0, first row at v = 0; for an equirectangular image luminance times the
    /// sine of the polar angle. At most 2^22 columns and rows. When all are 0 the distribution is empty.
    Distribution2d(std::span<const float> weights, size_t width, size_t height) : width_(width), height_(height) {
        std::vector<double> row(width), sums(height);
        rows_.resize(height + 1);
        columns_.resize(height * (width + 1));
        for (size_t y = 0; y < height; ++y) {
            for (size_t x = 0; x < width; ++x) {
                row[x] = static_cast<double>(weights[y * width + x]);
                sums[y] += row[x];
            }
            accumulate(row, sums[y], &columns_[y * (width + 1)]);
        }
        double total = 0;
        for (const double s : sums)
            total += s;
        if (total > 0)
            accumulate(sums, total, rows_.data());
        else
            *this = {};
    }

    bool empty() const { return rows_.empty(); }

    /// Not for an empty distribution.
    Distribution2dSample sample(Vec2f u) const {
        const Step y = find(rows_.data(), height_, u.y);
        const Step x = find(&columns_[y.index * (width_ + 1)], width_, u.x);
        return {{below_one((static_cast<float>(x.index) + x.offset) / static_cast<float>(width_)),
                 below_one((static_cast<float>(y.index) + y.offset) / static_cast<float>(height_))},
                density(x.index, y.index)};
    }

    /// uv in [0, 1)^2.
    float pdf(Vec2f uv) const {
        if (empty())
            return 0;
        const auto cell = [](float t, size_t n) {
            return std::min(static_cast<size_t>(std::max(0.0f, t) * static_cast<float>(n)), n - 1);
        };
        return density(cell(uv.x, width_), cell(uv.y, height_));
    }

  private:
    static constexpr uint32_t kSteps = 1u << 24;
    struct Step {
        size_t index;
        float offset;
    };

    static float below_one(float t) { return std::min(t, 0x1.fffffep-1f); }

    static void accumulate(const std::vector<double> &weights, double total, uint32_t *out) {
        uint32_t left =
            static_cast<uint32_t>(std::count_if(weights.begin(), weights.end(), [](double w) { return w > 0; }));
        double sum = 0;
        out[0] = 0;
        for (size_t i = 0; i < weights.size(); ++i) {
            out[i + 1] = out[i];
            if (!(weights[i] > 0))
                continue;
            sum += weights[i];
            --left; // positive weights still to come, each of which needs a step
            const auto ideal = static_cast<uint32_t>(std::min(1.0, sum / total) * kSteps + 0.5);
            out[i + 1] = left == 0 ? kSteps : std::clamp(ideal, out[i] + 1, kSteps - left);
        }
    }

    /// The cell that holds u and where in the cell, at the middle of the step.
    static Step find(const uint32_t *cumulative, size_t n, float u) {
        const auto step = static_cast<uint32_t>(u * static_cast<float>(kSteps));
        const auto i = static_cast<size_t>(std::upper_bound(cumulative, cumulative + n, step) - cumulative) - 1;
        return {i, (static_cast<float>(step - cumulative[i]) + 0.5f) /
                       static_cast<float>(cumulative[i + 1] - cumulative[i])};
    }

    float density(size_t x, size_t y) const {
        const uint32_t *column = &columns_[y * (width_ + 1) + x];
        const float p_row = static_cast<float>(rows_[y + 1] - rows_[y]) * static_cast<float>(height_) * 0x1p-24f;
        return p_row * static_cast<float>(column[1] - column[0]) * static_cast<float>(width_) * 0x1p-24f;
    }

    size_t width_ = 0, height_ = 0;
    std::vector<uint32_t> rows_;    // (height + 1)
    std::vector<uint32_t> columns_; // (height, width + 1)
};

} // namespace glimmer
