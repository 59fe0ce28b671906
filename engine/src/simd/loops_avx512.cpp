// SPDX-License-Identifier: GPL-3.0-or-later
// The loops, compiled for x86-64-v4 (see CMakeLists.txt).
#include "simd/loops_body.h"

namespace glimmer {

const Loops kLoopsAvx512 = {"AVX-512", connect, weigh, line_nodes};

} // namespace glimmer
