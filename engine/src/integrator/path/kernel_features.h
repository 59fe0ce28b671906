// SPDX-License-Identifier: GPL-3.0-or-later
// What a scene asks of the path integrator. Its code is compiled for a few sets of features (path_kernels.cpp): inside,
// a test of one costs nothing and takes with it the code and the part of a path's state that the set has no use for.
// All kernels draw the same numbers and do the same arithmetic, so they give the same bits: a feature may leave out
// what would bring nothing, never change what is drawn. What each saves: bench/features.cpp.
#pragma once

#include "integrator/path/estimator_flags.h"
#include "scene/scene.h"

#include <array>
#include <string>
#include <vector>

namespace glimmer {

struct KernelFeatures {
    bool medium = false;
    bool medium_walks = false; ///< medium that scatters, its light by paths alone: no vertices are shared
    bool surfaces = false;     ///< anything that scatters light, not only spheres that shine
    bool dielectrics = false;
    bool bvh = false;             ///< meshes, or more spheres than are tried one by one
    bool other_lights = false;    ///< than spheres that shine
    bool estimator_flags = false; ///< not all estimators are at work

    /// Lights are met by chance where light sampling could have found them.
    constexpr bool meets_lights() const { return surfaces || medium_walks; }
};

/// Each feature, and what is left out of a scene that does not need it; empty: nothing to tell.
struct FeatureText {
    bool KernelFeatures::*feature;
    const char *name; ///< for benchmarks
    const char *left_out;
};
inline constexpr std::array<FeatureText, 7> kFeatureTexts{{
    {&KernelFeatures::medium, "medium", "no fog: no distance sampling, no transmittance"},
    {&KernelFeatures::medium_walks, "walks in the medium", ""},
    {&KernelFeatures::surfaces, "surfaces", "no surface that scatters: no scattering at surfaces"},
    {&KernelFeatures::dielectrics, "dielectrics", "no glass: no search for the bodies around the camera"},
    {&KernelFeatures::bvh, "BVH", "a few spheres alone: no BVH"},
    {&KernelFeatures::other_lights, "other lights",
     "no lights but spheres that shine: no lamps, shining meshes, suns or sky"},
    {&KernelFeatures::estimator_flags, "estimator flags", ""},
}};
inline constexpr KernelFeatures kAllFeatures{true, true, true, true, true, true, true};

/// Whether a kernel with the features `has` can render what needs `needed`.
constexpr bool covers(const KernelFeatures &has, const KernelFeatures &needed) {
    for (const FeatureText &f : kFeatureTexts)
        if (needed.*f.feature && !(has.*f.feature))
            return false;
    return true;
}
static_assert(sizeof(KernelFeatures) == kFeatureTexts.size(), "a feature that no scene would be asked for");

/// shares: light vertices serve (plan_light_vertex_cache).
KernelFeatures needed_by(const Scene &scene, const EstimatorFlags &flags, bool shares);

/// What of the engine such a scene has no use for, in words.
std::vector<std::string> left_out(const KernelFeatures &needed);

} // namespace glimmer
