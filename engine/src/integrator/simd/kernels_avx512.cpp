// SPDX-License-Identifier: GPL-3.0-or-later
// The loops, compiled for x86-64-v4 (see CMakeLists.txt).
#include "integrator/simd/kernels_body.inl"

namespace glimmer {

const SimdKernels kSimdKernelsAvx512 = {"AVX-512", connect, weigh, table_nodes};

} // namespace glimmer
