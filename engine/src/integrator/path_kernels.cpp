// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/path_kernels.h"

#include "integrator/path_compiled.h"

#include <algorithm>

namespace glimmer {

namespace {

/// The least first; the last has all features.
constexpr PathKernel kKernels[] = {
    compiled<Features{.fog = true}>("spheres that shine, in fog or none"),
    compiled<Features{.surfaces = true, .bvh = true}>("surfaces lit by spheres, without fog and glass"),
    compiled<Features{.fog = true, .surfaces = true, .bvh = true}>("surfaces lit by spheres, in fog, without glass"),
    compiled<kEverything>("everything"),
};

} // namespace

const PathKernel &path_kernel(const Features &needed) {
    return *std::ranges::find_if(kKernels, [&](const PathKernel &k) { return covers(k.features, needed); });
}

} // namespace glimmer
