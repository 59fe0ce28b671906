// SPDX-License-Identifier: GPL-3.0-or-later
#include "simd/loops.h"

namespace glimmer {

const Loops *loops_avx512() {
    static const bool present = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                                __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                                __builtin_cpu_supports("avx512vl");
    return present ? &kLoopsAvx512 : nullptr;
}

const Loops &loops() {
    static const Loops &widest = loops_avx512() ? kLoopsAvx512 : kLoopsAvx2;
    return widest;
}

} // namespace glimmer
