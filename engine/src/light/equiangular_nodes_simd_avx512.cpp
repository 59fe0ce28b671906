// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/equiangular_nodes_simd.h"
#include "light/equiangular_nodes_simd.inl"

namespace glimmer {

const EquiangularNodes kEquiangularNodesAvx512 = table_nodes;

} // namespace glimmer
