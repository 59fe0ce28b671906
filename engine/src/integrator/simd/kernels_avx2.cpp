// SPDX-License-Identifier: GPL-3.0-or-later
// The loops with two registers of AVX2.
#include "integrator/simd/kernels_body.inl"

namespace glimmer {

const SimdKernels kSimdKernelsAvx2 = {"AVX2", connect, weigh, table_nodes};

} // namespace glimmer
