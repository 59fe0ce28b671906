// SPDX-License-Identifier: GPL-3.0-or-later
// Moments while the shutter is open.
#pragma once

#include "film/replicates.h"
#include "geometry/ray.h"
#include "sampling/hash.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace glimmer {

inline constexpr ShutterTime kMidShutter{0.5f}; ///< for pilots, which decide nothing but how the work is spent

/// Of all samples of a wave, since they share light vertices, whose surfaces have to be where the samples see them.
/// Each moment is uniform over seeds. Over the waves of one replicate they follow van der Corput's sequence, so that
/// few of them cover the shutter; replicates are shifted independently, or their spread would not tell of the error.
inline ShutterTime time_of_wave(uint64_t seed, uint64_t wave) {
    double moment = 0, digit = 0.5;
    for (uint64_t left = wave / kReplicates; left; left >>= 1, digit /= 2)
        moment += double(left & 1) * digit;
    moment += double(hash64(seed, uint64_t(0x5407), wave % kReplicates) >> 11) * 0x1p-53;
    return ShutterTime(std::min(float(moment - std::floor(moment)), 1 - 0x1p-24f));
}

} // namespace glimmer
