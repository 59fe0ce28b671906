// SPDX-License-Identifier: GPL-3.0-or-later
// Local majorants of a medium that varies: a grid of cells over its body, in the body's own space, each with a rate at
// which tracking looks for collisions there.
#pragma once

#include "geometry/ray.h"
#include "math/vec.h"

#include <array>
#include <functional>
#include <vector>

namespace glimmer {

class MajorantGrid {
  public:
    /// extinction(p): the largest of the channels at a point of the body's space. Cells are cubes, about `cells` of
    /// them between the corners `low` and `high`.
    ///
    /// The extinction is sampled at the corners of a lattice finer than the cells. A majorant is the largest value in a
    /// cell and a step of the lattice around it, with a margin by how much it varies there, and never less than a small
    /// part of the largest of all: between samples there may be more. No estimator relies on a majorant being one
    /// (medium/null_collision.cpp): where it is none, weights grow and may be negative, but their mean is right.
    MajorantGrid(const Vec3f &low, const Vec3f &high, uint32_t cells, uint32_t threads,
                 const std::function<float(const Vec3f &)> &extinction);

    float largest() const { return largest_; }
    float mean() const { return mean_; }
    size_t bytes() const { return majorants_.size() * sizeof(float); }

    /// Goes through the cells along a line, which is given in the body's space and need not be of unit length.
    class Walk {
      public:
        Walk(const MajorantGrid &grid, const Vec3f &origin, const Vec3f &direction, float begin, float end);
        float end() const { return exit_; }          ///< where the part that begins at the last end() ends
        float majorant() const { return majorant_; } ///< in that part
        void next();

      private:
        void enter();
        const MajorantGrid *grid_;
        float t_, last_, first_; ///< the line is within the grid from `first_` to `last_`
        std::array<float, 3> crossing_{}, step_{};
        std::array<int, 3> cell_{}, way_{};
        float exit_ = 0, majorant_ = 0;
        float end_;
        bool inside_ = false;
    };

  private:
    float at(const std::array<int, 3> &cell) const {
        return majorants_[(size_t(cell[2]) * size_t(count_[1]) + size_t(cell[1])) * size_t(count_[0]) +
                          size_t(cell[0])];
    }

    Vec3f low_, high_;
    float size_ = 1; ///< of a cell
    std::array<int, 3> count_{1, 1, 1};
    std::vector<float> majorants_;
    float largest_ = 0, mean_ = 0;
};

} // namespace glimmer
