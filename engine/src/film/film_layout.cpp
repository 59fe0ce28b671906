// SPDX-License-Identifier: GPL-3.0-or-later
#include "film/film_layout.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace glimmer {

FilmLayout::FilmLayout(uint32_t width, uint32_t height, uint32_t tile_size, const FilmReach &reach)
    : width_(width), height_(height), tile_size_(tile_size), reach_(reach), before_x_(reach.x % tile_size),
      before_y_(reach.y % tile_size) {
    lay_out_tiles();
    lay_out_cells();
}

void FilmLayout::lay_out_tiles() {
    const uint32_t rows = (before_y_ + height_ + tile_size_ - 1) / tile_size_;
    tile_columns_ = (before_x_ + width_ + tile_size_ - 1) / tile_size_;
    std::vector<uint32_t> order(size_t(tile_columns_) * rows);
    std::iota(order.begin(), order.end(), 0u);
    const auto part = [&](uint32_t i, uint32_t before, uint32_t size) { // [begin, end) of a column or row
        const uint32_t begin = i * tile_size_, end = begin + tile_size_;
        return std::array{std::max(begin, before) - before, std::min(end - before, size)};
    };
    const auto tile = [&](uint32_t i) {
        const auto [x0, x1] = part(i % tile_columns_, before_x_, width_);
        const auto [y0, y1] = part(i / tile_columns_, before_y_, height_);
        return Rectangle{x0, y0, x1 - x0, y1 - y0};
    };
    const auto off_center = [&](uint32_t i) {
        const Rectangle r = tile(i);
        const double dx = r.x + 0.5 * r.width - 0.5 * width_, dy = r.y + 0.5 * r.height - 0.5 * height_;
        return dx * dx + dy * dy;
    };
    std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return off_center(a) < off_center(b); });
    tile_of_grid_.resize(order.size());
    for (const uint32_t i : order) {
        tile_of_grid_[i] = uint32_t(tiles_.size());
        tiles_.push_back(tile(i));
    }
}

FilmLayout::Cell FilmLayout::make_cell(int32_t column, int32_t row) const {
    const auto reach = int32_t(reach_.pixels), width = int32_t(width_), height = int32_t(height_);
    // [begin, end) of a column or row, cut off `beyond` pixels beyond the picture.
    const auto part = [](int32_t i, uint32_t origin, int32_t size, int32_t beyond) {
        const int32_t begin = i * int32_t(kCellSize) - int32_t(origin), end = begin + int32_t(kCellSize);
        return std::array{std::max(begin, -beyond), std::min(end, size + beyond)};
    };
    const auto [x0, x1] = part(column, reach_.x, width, reach);
    const auto [y0, y1] = part(row, reach_.y, height, reach);
    const Area reached{std::max(x0 - reach, 0), std::max(y0 - reach, 0), std::min(x1 + reach, width),
                       std::min(y1 + reach, height)};
    const int32_t x = std::clamp(x0, 0, width - 1), y = std::clamp(y0, 0, height - 1);
    const auto [bx0, bx1] = part(cell_at(x, reach_.x), reach_.x, width, 0);
    const auto [by0, by1] = part(cell_at(y, reach_.y), reach_.y, height, 0);
    return {{x0, y0, x1, y1},
            reached,
            {uint32_t(bx0), uint32_t(by0), uint32_t(bx1 - bx0), uint32_t(by1 - by0)},
            tile_at(uint32_t(x), uint32_t(y))};
}

void FilmLayout::lay_out_cells() {
    const int32_t first_column = cells_around(0, reach_.x)[0], last_column = cells_around(width_ - 1, reach_.x)[1];
    const int32_t first_row = cells_around(0, reach_.y)[0], last_row = cells_around(height_ - 1, reach_.y)[1];
    first_column_ = first_column;
    first_row_ = first_row;
    columns_ = uint32_t(last_column - first_column + 1);
    std::vector<std::pair<Cell, size_t>> all; // with their places in the grid
    for (int32_t row = first_row; row <= last_row; ++row)
        for (int32_t column = first_column; column <= last_column; ++column)
            all.emplace_back(make_cell(column, row), grid_place(column, row));
    const auto key = [](const auto &c) { return std::tuple(c.first.tile, c.first.block.y, c.first.block.x); };
    std::stable_sort(all.begin(), all.end(), [&](const auto &a, const auto &b) { return key(a) < key(b); });
    cell_of_grid_.resize(all.size());
    cells_.resize(tiles_.size());
    for (auto &[cell, place] : all) {
        cell.begin = slots_;
        slots_ += cell.reached.pixels();
        cell_of_grid_[place] = {uint32_t(cell.tile), uint32_t(cells_[cell.tile].size())};
        cells_[cell.tile].push_back(cell);
    }
}

std::vector<size_t> FilmLayout::tiles_that_reach(size_t tile) const {
    const Rectangle &r = tiles_[tile];
    // A sample beyond the picture belongs to the tile nearest to it, so none of another tile is missed.
    const auto range = [&](uint32_t first, uint32_t size, uint32_t before, uint32_t whole) {
        const uint32_t begin = first - std::min(first, reach_.pixels),
                       last = std::min(first + size - 1 + reach_.pixels, whole - 1);
        return std::array{(before + begin) / tile_size_, (before + last) / tile_size_};
    };
    const auto [i0, i1] = range(r.x, r.width, before_x_, width_);
    const auto [j0, j1] = range(r.y, r.height, before_y_, height_);
    std::vector<size_t> result;
    for (uint32_t j = j0; j <= j1; ++j)
        for (uint32_t i = i0; i <= i1; ++i)
            result.push_back(tile_of_grid_[size_t(j) * tile_columns_ + i]);
    std::sort(result.begin(), result.end());
    return result;
}

} // namespace glimmer
