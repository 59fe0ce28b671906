// SPDX-License-Identifier: GPL-3.0-or-later
// How code is compiled for two instruction sets and chosen at run time. Every processor that can run the engine has
// AVX2 (x86-64-v3); some have AVX-512 (x86-64-v4). A concept with such code has
//   NAME_simd.h           a table of function pointers, and which table to use,
//   NAME_simd.inl         the functions, once, on sixteen lanes (float16.h),
//   NAME_simd.cpp         the table for AVX2,
//   NAME_simd_avx512.cpp  the table for AVX-512, with the same bits; CMakeLists.txt sets the flags of these files.
// Nothing in the .inl may have linkage, nor may it call an inline function: one that was compiled for AVX-512 could be
// the copy that the linker keeps, and end the program on a processor without it.
#pragma once

#include <cstddef>

namespace glimmer {

inline constexpr size_t kSimdLanes = 16; ///< numbers that are worked on at a time, with either instruction set

/// Whether this processor has what the _avx512.cpp files are compiled for.
bool has_avx512();

} // namespace glimmer
