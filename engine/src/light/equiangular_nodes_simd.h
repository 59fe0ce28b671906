// SPDX-License-Identifier: GPL-3.0-or-later
// The values of an equiangular table at its nodes, all sixteen at a time; how such code is compiled and chosen:
// math/simd/instruction_set.h.
#pragma once

#include "math/simd/instruction_set.h"
#include "medium/simd_medium.h"

#include <cstddef>

namespace glimmer {

/// Nodes of an EquiangularTable.
inline constexpr size_t kTableNodes = 16;
static_assert(kTableNodes == kSimdLanes, "one register holds all nodes");

/// A segment and a light as the table sees them; lengths but for x_first and x_step.
struct TableShape {
    double t_foot;          ///< where the segment's line passes nearest to the light's centre
    double h;               ///< softened distance of the centre to the line
    double h2;              ///< squared distance of the centre to the line, not softened
    double radius;          ///< of the light; 0 for a point
    double distance;        ///< of the light's centre from the segment's beginning
    double cut;             ///< where the table ends
    double x_first, x_step; ///< of the nodes, see EquiangularTable
};

/// Writes the density per x at the nodes (kTableNodes,) and returns the density per t / h at the cut, all up to one
/// common factor.
using EquiangularNodes = float (*)(const SimdMedium &medium, const TableShape &shape, float *density);

extern const EquiangularNodes kEquiangularNodesAvx2, kEquiangularNodesAvx512;

/// The one for the widest instruction set that this processor has.
float equiangular_nodes(const SimdMedium &medium, const TableShape &shape, float *density);

} // namespace glimmer
