// SPDX-License-Identifier: GPL-3.0-or-later
// The loops with two registers of AVX2.
#include "simd/loops_body.h"

namespace glimmer {

const Loops kLoopsAvx2 = {"AVX2", connect, weigh, line_nodes};

} // namespace glimmer
