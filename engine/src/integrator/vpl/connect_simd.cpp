// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/vpl/connect_simd.h"

#include "integrator/vpl/connect_simd.inl"

namespace glimmer {

const ConnectKernels kConnectAvx2 = {"AVX2", connect, pick_targets, diffuse};

const ConnectKernels &connect_kernels() {
    static const ConnectKernels &widest = has_avx512() ? kConnectAvx512 : kConnectAvx2;
    return widest;
}

} // namespace glimmer
