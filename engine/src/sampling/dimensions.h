// SPDX-License-Identifier: GPL-3.0-or-later
// Which stratified numbers each decision of a camera sample is made by. Two decisions that shared a dimension would be
// correlated, and the picture wrong: so all of them stand in this one table, and the compiler looks for overlaps.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace glimmer {

/// The decisions at which a sample is stratified over its pixel: those of the camera ray and of its first vertices.
/// Everything later draws independent numbers (Sampler::next_*).
enum class Dimension : uint32_t {
    film,               ///< the place in the pixel's filter
    lens,               ///< the point of the lens
    time,               ///< the moment while the shutter is open
    medium_distance,    ///< how far along the camera's segment the path scatters in the medium
    medium_direction,   ///< the phase function's sample there
    segment_distance,   ///< of each light, the point of the camera's segment that it is sampled from
    segment_light,      ///< of each light, the point on the light for that
    surface_light,      ///< of each light, the point on it that is sampled from the first surface
    branch_lobe,        ///< of each branch of the first surface, the lobe that it leaves by
    branch_direction,   ///< and its direction
    candidate_film,     ///< of each RIS candidate, its place in its part of the pixel
    candidate_lobe,     ///< of the candidate that was chosen, the lobe of its BSDF sample
    candidate_direction ///< and its direction
};

/// The decision's numbers begin, begin + stride, ..., `count` of them. Each number stands for a pair of dimensions in
/// the sense of a Sobol sequence: Sampler::stratified_1d and stratified_2d take one.
struct DimensionRange {
    std::string_view name;
    uint32_t begin, count;
    uint32_t stride = 1;
};

/// In the order of the enumeration. The numbers are keys of scrambles: others give another picture of the same mean.
inline constexpr std::array<DimensionRange, 13> kDimensions{{
    {"film", 0, 1},
    {"lens", 1, 1},
    {"time", 4, 1},
    {"medium distance", 2, 1},
    {"medium direction", 3, 1},
    {"segment distance", 16, 16, 2},
    {"segment light", 17, 16, 2},
    {"surface light", 80, 16},
    {"branch lobe", 128, 4, 2},
    {"branch direction", 129, 4, 2},
    {"candidate film", 160, 4},
    {"candidate lobe", 176, 1},
    {"candidate direction", 177, 1},
}};
static_assert(kDimensions.size() == size_t(Dimension::candidate_direction) + 1, "a decision without numbers");

/// How many numbers the decision has.
constexpr uint32_t dimension_count(Dimension decision) {
    return kDimensions[size_t(decision)].count;
}

/// The number of the decision's i-th instance, i < dimension_count(decision).
constexpr uint32_t dimension(Dimension decision, uint32_t i = 0) {
    const DimensionRange &range = kDimensions[size_t(decision)];
    return range.begin + range.stride * i;
}

/// Whether no number belongs to two decisions.
constexpr bool dimensions_are_disjoint() {
    std::array<bool, 256> taken{};
    for (const DimensionRange &range : kDimensions)
        for (uint32_t i = 0; i < range.count; ++i) {
            bool &mine = taken[range.begin + range.stride * i]; // beyond the array this does not compile
            if (mine)
                return false;
            mine = true;
        }
    return true;
}
static_assert(dimensions_are_disjoint(), "two decisions would draw the same numbers");

} // namespace glimmer
