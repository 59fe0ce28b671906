// SPDX-License-Identifier: GPL-3.0-or-later
// Version, last error and the tables.
#include "api/handles.h"
#include "film/passes.h"
#include "geometry/embree.h"
#include "math/simd/instruction_set.h"

namespace glimmer {

namespace {
thread_local std::string last_error;
}

glimmer_result keep_error(glimmer_result code, const char *message) noexcept {
    try {
        last_error = message;
        for (char &c : last_error) // one line, whatever the names in it hold
            if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
                c = ' ';
    } catch (...) {
        last_error.clear();
    }
    return code;
}

} // namespace glimmer

extern "C" {

uint32_t glimmer_abi_version(void) {
    return GLIMMER_ABI_VERSION;
}

const char *glimmer_version(void) {
    return GLIMMER_VERSION;
}

const char *glimmer_build_info(void) {
#if defined(__clang__)
#define GLIMMER_BUILT_WITH "Clang " __clang_version__ ", Embree " RTC_VERSION_STRING
#else
#define GLIMMER_BUILT_WITH "GCC " __VERSION__ ", Embree " RTC_VERSION_STRING
#endif
    return glimmer::has_avx512() ? GLIMMER_BUILT_WITH ", AVX-512" : GLIMMER_BUILT_WITH ", AVX2";
}

const char *glimmer_last_error(void) {
    return glimmer::last_error.c_str();
}

const glimmer_pass_info_t *glimmer_pass_info(uint32_t pass) {
    return pass < glimmer::kPasses.size() ? &glimmer::kPasses[pass].info : nullptr;
}

const glimmer_integrator_info_t *glimmer_integrator_info(uint32_t index) {
    return index < glimmer::kIntegrators.size() ? &glimmer::kIntegrators[index] : nullptr;
}
}
