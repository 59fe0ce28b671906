// SPDX-License-Identifier: GPL-3.0-or-later
// How a film is cut up: into tiles, which are rendered one by one, and those into cells, whose samples are summed up
// apart.
//
// A sample may count for several pixels (FilterWeights in pixel_filter.h). So that a picture depends neither on tiles
// nor on the crop nor on the order of work, the sums of all pixels are kept by the cells of a grid that all pictures
// share: each cell has sums of its own of the pixels that its samples reach, and a pixel is the sum of what it has in
// a few cells. Samples are taken beyond the edge of the picture too, as far as they reach into it.
#pragma once

#include "math/rectangle.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace glimmer {

/// The side of a cell, in pixels.
inline constexpr uint32_t kCellSize = 32;

/// How far the samples of a film count, and where its grid of cells begins: (x, y) pixels to the left of the picture
/// and above it, or a multiple of kCellSize farther.
struct FilmReach {
    uint32_t pixels = 0, x = 0, y = 0;
};

class FilmLayout {
  public:
    /// Pixels [x0, x1) by [y0, y1) about the picture's first one.
    struct Area {
        int32_t x0, y0, x1, y1;
        bool holds(int32_t x, int32_t y) const { return x >= x0 && x < x1 && y >= y0 && y < y1; }
        size_t pixels() const { return size_t(x1 - x0) * size_t(y1 - y0); }
    };
    struct Cell {
        Area sampled;    ///< the pixels that its samples are taken in, of which some may lie beyond the picture
        Area reached;    ///< the pixels of the picture that they count for
        Rectangle block; ///< the pixels of the picture nearest to them: what these share serves for them
        size_t tile;
        size_t begin = 0; ///< of its sums among those of all cells
        size_t slot(int32_t x, int32_t y) const {
            return begin + size_t(y - reached.y0) * size_t(reached.x1 - reached.x0) + size_t(x - reached.x0);
        }
    };

    /// tile_size: a multiple of kCellSize.
    FilmLayout(uint32_t width, uint32_t height, uint32_t tile_size, const FilmReach &reach);

    /// In the order of rendering: from the centre outwards.
    const std::vector<Rectangle> &tiles() const { return tiles_; }
    size_t tile_at(uint32_t x, uint32_t y) const {
        return tile_of_grid_[size_t((before_y_ + y) / tile_size_) * tile_columns_ + (before_x_ + x) / tile_size_];
    }
    /// Those of a tile; such of one block come one after the other, and their sums do.
    const std::vector<Cell> &cells(size_t tile) const { return cells_[tile]; }
    size_t slots() const { return slots_; } ///< sums of all cells
    uint32_t reach() const { return reach_.pixels; }

    /// function(cell) for the cells whose samples count for a pixel, always in the same order.
    template <class Function>
    void for_cells_at(uint32_t x, uint32_t y, const Function &function) const {
        const auto [i0, i1] = cells_around(x, reach_.x);
        const auto [j0, j1] = cells_around(y, reach_.y);
        for (int32_t j = j0; j <= j1; ++j)
            for (int32_t i = i0; i <= i1; ++i) {
                const auto [tile, number] = cell_of_grid_[grid_place(i, j)];
                function(cells_[tile][number]);
            }
    }
    /// The tiles that have a cell whose samples count in a tile, itself among them, in ascending order.
    std::vector<size_t> tiles_that_reach(size_t tile) const;

  private:
    /// The cell of the grid that a pixel lies in, by column or row.
    static int32_t cell_at(int32_t pixel, uint32_t origin) {
        const int32_t place = pixel + int32_t(origin), size = int32_t(kCellSize);
        return place >= 0 ? place / size : -((size - 1 - place) / size);
    }
    std::array<int32_t, 2> cells_around(uint32_t pixel, uint32_t origin) const {
        const auto reach = int32_t(reach_.pixels), at = int32_t(pixel);
        return {cell_at(at - reach, origin), cell_at(at + reach, origin)};
    }
    size_t grid_place(int32_t i, int32_t j) const {
        return size_t(j - first_row_) * columns_ + size_t(i - first_column_);
    }
    void lay_out_tiles();
    void lay_out_cells();
    Cell make_cell(int32_t column, int32_t row) const;

    uint32_t width_, height_, tile_size_, tile_columns_ = 0;
    FilmReach reach_;
    uint32_t before_x_, before_y_; ///< how much of the grid's first tiles lies before the picture
    std::vector<Rectangle> tiles_;
    std::vector<uint32_t> tile_of_grid_;       ///< row by row
    int32_t first_column_ = 0, first_row_ = 0; ///< of cells
    uint32_t columns_ = 0;
    std::vector<std::vector<Cell>> cells_;              ///< by tile
    std::vector<std::array<uint32_t, 2>> cell_of_grid_; ///< tile and number within it, row by row
    size_t slots_ = 0;
};

} // namespace glimmer
