// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/path/kernels.h"

#include <algorithm>

namespace glimmer {

namespace {

/// The fewest features first; the last has all.
constexpr PathKernel kKernels[] = {
    compiled<kSpheres>("spheres that shine, in fog or none"),
    compiled<kSurfaces>("surfaces lit by spheres, without fog and glass"),
    compiled<kSurfacesInFog>("surfaces lit by spheres, in fog, without glass"),
    compiled<kEverythingButPasses>("everything"),
    compiled<kAllFeatures>("everything, and its passes"),
};

} // namespace

const PathKernel &path_kernel(const KernelFeatures &needed) {
    return *std::ranges::find_if(kKernels, [&](const PathKernel &k) { return covers(k.features, needed); });
}

} // namespace glimmer
