// SPDX-License-Identifier: GPL-3.0-or-later
#include "medium/majorant_grid.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

namespace glimmer {

namespace {

constexpr int kSteps = 3;               // of the lattice in a cell
constexpr float kMargin = 0.5f;         // of how much the extinction varies in a cell
constexpr float kLeastOfLargest = .01f; // no majorant is less than this part of the largest
constexpr float kLeastPerCell = .05f;   // of those that are raised: most expected looks in a cell

void for_each(int count, uint32_t threads, const std::function<void(int)> &body) {
    const uint32_t most = threads ? threads : std::max(1u, std::thread::hardware_concurrency());
    std::atomic<int> next{0};
    const auto work = [&] {
        for (int i = next++; i < count; i = next++)
            body(i);
    };
    std::vector<std::thread> helpers;
    for (uint32_t i = 1; i < std::min(most, uint32_t(count)); ++i)
        helpers.emplace_back(work);
    work();
    for (std::thread &helper : helpers)
        helper.join();
}

} // namespace

MajorantGrid::MajorantGrid(const Vec3f &low, const Vec3f &high, uint32_t cells, uint32_t threads,
                           const std::function<float(const Vec3f &)> &extinction)
    : low_(low), high_(high) {
    const Vec3f extent = high - low;
    const float longest = std::max(max_abs(extent), 1e-30f);
    // The side of cubes that fill the box; a flat box counts as one of some thickness.
    const float least = longest / float(cells);
    const auto side = [&](int axis) { return std::max(extent[axis], least); };
    size_ = std::cbrt(side(0) * side(1) / float(cells) * side(2));
    std::array<int, 3> lattice{};
    for (int axis = 0; axis < 3; ++axis) {
        count_[size_t(axis)] = std::clamp(int(std::ceil(extent[axis] / size_ - 1e-3f)), 1, int(cells));
        lattice[size_t(axis)] = count_[size_t(axis)] * kSteps + 1;
    }
    const int nx = lattice[0], ny = lattice[1], nz = lattice[2];
    std::vector<float> values(size_t(nx) * size_t(ny) * size_t(nz));
    const auto index = [&](int x, int y, int z) {
        return (size_t(z) * size_t(ny) + size_t(y)) * size_t(nx) + size_t(x);
    };
    for_each(nz, threads, [&](int z) {
        for (int y = 0; y < ny; ++y)
            for (int x = 0; x < nx; ++x) {
                const float step = size_ / kSteps;
                const Vec3f p(std::min(low.x + float(x) * step, high.x), std::min(low.y + float(y) * step, high.y),
                              std::min(low.z + float(z) * step, high.z));
                values[index(x, y, z)] = extinction(p);
            }
    });
    double sum = 0;
    for (const float v : values) {
        largest_ = std::max(largest_, v);
        sum += double(v);
    }
    mean_ = float(sum / double(values.size()));
    majorants_.resize(size_t(count_[0]) * size_t(count_[1]) * size_t(count_[2]));
    size_t out = 0;
    for (int z = 0; z < count_[2]; ++z)
        for (int y = 0; y < count_[1]; ++y)
            for (int x = 0; x < count_[0]; ++x) {
                float most = 0, fewest = kInfinity;
                const auto range = [](int cell, int n) {
                    return std::array<int, 2>{std::max(cell * kSteps - 1, 0), std::min((cell + 1) * kSteps + 1, n - 1)};
                };
                const auto xs = range(x, nx), ys = range(y, ny), zs = range(z, nz);
                for (int k = zs[0]; k <= zs[1]; ++k)
                    for (int j = ys[0]; j <= ys[1]; ++j)
                        for (int i = xs[0]; i <= xs[1]; ++i) {
                            const float v = values[index(i, j, k)];
                            most = std::max(most, v);
                            fewest = std::min(fewest, v);
                        }
                majorants_[out++] = most + kMargin * (most - fewest);
            }
    for (float &majorant : majorants_)
        majorant = std::max(majorant, std::min(kLeastOfLargest * largest_, kLeastPerCell / size_));
    for (const float majorant : majorants_)
        largest_ = std::max(largest_, majorant);
}

MajorantGrid::Walk::Walk(const MajorantGrid &grid, const Vec3f &origin, const Vec3f &direction, float begin, float end)
    : grid_(&grid), t_(begin), last_(end), first_(begin), end_(end) {
    for (int axis = 0; axis < 3; ++axis) {
        const float o = origin[axis], d = direction[axis];
        const float near = (d >= 0 ? grid.low_[axis] : grid.high_[axis]) - o;
        const float far = (d >= 0 ? grid.high_[axis] : grid.low_[axis]) - o;
        if (d != 0) {
            first_ = std::max(first_, near / d);
            last_ = std::min(last_, far / d);
        } else if (near > 0 || far < 0) {
            last_ = -1;
        }
    }
    inside_ = first_ < last_;
    if (inside_)
        for (int axis = 0; axis < 3; ++axis) {
            const auto a = size_t(axis);
            const float d = direction[axis], p = origin[axis] + d * first_ - grid.low_[axis];
            cell_[a] = std::clamp(int(p / grid.size_), 0, grid.count_[a] - 1);
            way_[a] = d > 0 ? 1 : -1;
            step_[a] = d != 0 ? grid.size_ / std::abs(d) : kInfinity;
            const float wall = grid.low_[axis] + grid.size_ * float(cell_[a] + (d > 0 ? 1 : 0));
            crossing_[a] = d != 0 ? (wall - origin[axis]) / d : kInfinity;
        }
    enter();
}

void MajorantGrid::Walk::enter() {
    if (!inside_ || t_ >= last_) {
        exit_ = end_, majorant_ = 0;
    } else if (t_ < first_) {
        exit_ = first_, majorant_ = 0;
    } else {
        exit_ = std::min({crossing_[0], crossing_[1], crossing_[2], last_});
        majorant_ = grid_->at(cell_);
    }
}

void MajorantGrid::Walk::next() {
    const bool was_before = t_ < first_;
    t_ = exit_;
    if (!was_before && inside_ && t_ < last_) {
        const size_t axis = crossing_[0] <= crossing_[1] ? (crossing_[0] <= crossing_[2] ? 0 : 2)
                                                         : (crossing_[1] <= crossing_[2] ? 1 : 2);
        cell_[axis] += way_[axis];
        if (cell_[axis] < 0 || cell_[axis] >= grid_->count_[axis]) { // by rounding alone, at the wall
            cell_[axis] -= way_[axis];
            crossing_[axis] = kInfinity;
        } else {
            crossing_[axis] += step_[axis];
        }
    }
    enter();
}

} // namespace glimmer
