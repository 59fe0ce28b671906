// SPDX-License-Identifier: GPL-3.0-or-later
// The host's floating-point mode, left outside the engine.
#pragma once

#include <immintrin.h>

namespace glimmer {

/// While it lives, this thread computes by IEEE 754's defaults: to nearest, denormals kept, no traps. Blender's threads
/// flush denormals to zero, which turns the light of a moon of radiance 1e-39 off, and e^-100 black.
class FloatMode {
  public:
    FloatMode() : before_(_mm_getcsr()) { _mm_setcsr(0x1f80); }
    ~FloatMode() { _mm_setcsr(before_); }
    FloatMode(const FloatMode &) = delete;
    FloatMode &operator=(const FloatMode &) = delete;

  private:
    unsigned before_;
};

} // namespace glimmer
