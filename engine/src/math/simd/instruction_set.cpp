// SPDX-License-Identifier: GPL-3.0-or-later
#include "math/simd/instruction_set.h"

namespace glimmer {

bool has_avx512() {
    static const bool present = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                                __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                                __builtin_cpu_supports("avx512vl");
    return present;
}

} // namespace glimmer
