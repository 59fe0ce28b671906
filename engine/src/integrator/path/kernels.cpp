// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/path/kernels.h"

#include "integrator/path/kernel.inl"

#include <algorithm>

namespace glimmer {

namespace {

constexpr KernelFeatures without_passes(KernelFeatures features) {
    features.passes = false;
    return features;
}

/// The fewest features first; the last has all.
constexpr PathKernel kKernels[] = {
    compiled<KernelFeatures{.medium = true}>("spheres that shine, in fog or none"),
    compiled<KernelFeatures{.surfaces = true, .bvh = true}>("surfaces lit by spheres, without fog and glass"),
    compiled<KernelFeatures{.medium = true, .surfaces = true, .bvh = true}>(
        "surfaces lit by spheres, in fog, without glass"),
    compiled<without_passes(kAllFeatures)>("everything"),
    compiled<kAllFeatures>("everything, and its passes"),
};

} // namespace

const PathKernel &path_kernel(const KernelFeatures &needed) {
    return *std::ranges::find_if(kKernels, [&](const PathKernel &k) { return covers(k.features, needed); });
}

} // namespace glimmer
