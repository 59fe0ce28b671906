// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/equiangular_nodes_simd.h"

#include "light/equiangular_nodes_simd.inl"

namespace glimmer {

const EquiangularNodes kEquiangularNodesAvx2 = table_nodes;

float equiangular_nodes(const SimdMedium &medium, const TableShape &shape, float *density) {
    static const EquiangularNodes widest = has_avx512() ? kEquiangularNodesAvx512 : kEquiangularNodesAvx2;
    return widest(medium, shape, density);
}

} // namespace glimmer
