// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/vpl/spatial_order.h"

#include <algorithm>
#include <bit>

namespace glimmer {

namespace {

constexpr uint32_t kBits = 10; // of the curve for each axis

/// Two zeros between each two of the lowest kBits bits.
uint32_t spread(uint32_t bits) {
    bits = (bits | bits << 16) & 0x030000ffu;
    bits = (bits | bits << 8) & 0x0300f00fu;
    bits = (bits | bits << 4) & 0x030c30c3u;
    return (bits | bits << 2) & 0x09249249u;
}

/// Numbers in the order of floats, also of those that are none.
uint32_t ordered_bits(float x) {
    const auto bits = std::bit_cast<uint32_t>(x);
    return bits >> 31 ? ~bits : bits | 1u << 31;
}

/// Indices of positions in the order of the curve. Cells hold equal numbers, not equal lengths, along each axis: light
/// subpaths leave vertices far away as well, and in a cube about all of them the rest would share one cell.
template <class Position>
std::vector<uint32_t> curve_order(size_t count, const Position &position) {
    std::vector<uint32_t> codes(count, 0);
    std::vector<uint64_t> keys(count); // the index in the lower half
    for (int axis = 0; axis < 3; ++axis) {
        for (size_t i = 0; i < count; ++i)
            keys[i] = uint64_t(ordered_bits(position(i)[axis])) << 32 | i;
        std::sort(keys.begin(), keys.end());
        for (size_t rank = 0; rank < count; ++rank)
            codes[uint32_t(keys[rank])] |= spread(uint32_t((uint64_t(rank) << kBits) / count)) << axis;
    }
    for (size_t i = 0; i < count; ++i)
        keys[i] = uint64_t(codes[i]) << 32 | i;
    std::sort(keys.begin(), keys.end());
    for (size_t i = 0; i < count; ++i)
        codes[i] = uint32_t(keys[i]);
    return codes;
}

} // namespace

void sort_in_space(LightVertices &vertices) {
    const MediumVertices &medium = vertices.medium;
    MediumVertices sorted;
    sorted.directed = medium.directed;
    sorted.counted = medium.counted;
    sorted.grouped = medium.grouped;
    for (const uint32_t i : curve_order(medium.size(), [&](size_t k) { return medium.position(k); }))
        sorted.add(medium, i, 1);
    vertices.medium = std::move(sorted);

    const std::vector<SurfaceVertex> &surface = vertices.surface;
    std::vector<SurfaceVertex> sorted_surface;
    sorted_surface.reserve(surface.size());
    for (const uint32_t i : curve_order(surface.size(), [&](size_t k) { return surface[k].position; }))
        sorted_surface.push_back(surface[i]);
    vertices.surface = std::move(sorted_surface);
}

} // namespace glimmer
