// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/vpl/connect_simd.h"
#include "integrator/vpl/connect_simd.inl"

namespace glimmer {

const ConnectKernels kConnectAvx512 = {"AVX-512", connect, pick_targets, diffuse};

} // namespace glimmer
