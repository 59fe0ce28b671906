// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/simd/kernels.h"

namespace glimmer {

const SimdKernels *simd_kernels_avx512() {
    static const bool present = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                                __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                                __builtin_cpu_supports("avx512vl");
    return present ? &kSimdKernelsAvx512 : nullptr;
}

const SimdKernels &simd_kernels() {
    static const SimdKernels &widest = simd_kernels_avx512() ? kSimdKernelsAvx512 : kSimdKernelsAvx2;
    return widest;
}

} // namespace glimmer
