// SPDX-License-Identifier: GPL-3.0-or-later
// What a scene needs of the path integrator. The inner loop is compiled for a few sets of features (kernels.h).
// Within it, a test of a feature costs nothing, and without the feature its code and its part of the path's state are
// gone. All kernels draw the same random numbers and do the same arithmetic, so that they give the same bits: a feature
// may leave out what would bring nothing, but never change what is drawn. What each saves: bench/features.cpp.
#pragma once

#include "integrator/path/estimator_flags.h"
#include "scene/scene.h"

#include <array>
#include <string>
#include <vector>

namespace glimmer {

struct KernelFeatures {
    bool medium = false;
    bool bounded_media = false;   ///< media that have an end; else one fills all space
    bool varying_media = false;   ///< media that shader programs give from place to place
    bool medium_walks = false;    ///< the medium scatters, and paths walk through it by themselves: no light vertices
    bool surfaces = false;        ///< surfaces that scatter light, not only emissive spheres
    bool transmission = false;    ///< surfaces that scatter light to their other side; glass among them
    bool transparency = false;    ///< surfaces that let some light straight through
    bool subsurface = false;      ///< bodies in which light wanders beneath the surface
    bool terminators = false;     ///< smooth meshes that lamps see as curved
    bool bvh = false;             ///< there are meshes, or more spheres than are tried one by one
    bool other_lights = false;    ///< lights other than emissive spheres
    bool visibility = false;      ///< objects, lights or an environment that some rays do not see
    bool estimator_flags = false; ///< not all of EstimatorFlags are set
    bool passes = false;          ///< passes of PassSample, or a transparent film

    /// Whether paths can meet a light by chance that light sampling could have found.
    constexpr bool meets_lights() const { return surfaces || medium_walks; }
};

/// A feature, and the line that tells a user what is left out of a scene that does not need it (may be empty).
struct FeatureText {
    bool KernelFeatures::*feature;
    const char *name; ///< for benchmarks
    const char *left_out;
};
inline constexpr std::array<FeatureText, 14> kFeatureTexts{{
    {&KernelFeatures::medium, "medium", "no fog: no distance sampling, no transmittance"},
    {&KernelFeatures::bounded_media, "bounded media", ""},
    {&KernelFeatures::varying_media, "varying media", ""},
    {&KernelFeatures::medium_walks, "walks in the medium", ""},
    {&KernelFeatures::surfaces, "surfaces", "no surface that scatters: no scattering at surfaces"},
    {&KernelFeatures::transmission, "transmission", "no glass: no search for the bodies around the camera"},
    {&KernelFeatures::transparency, "transparency", ""},
    {&KernelFeatures::subsurface, "subsurface scattering", ""},
    {&KernelFeatures::terminators, "shadow terminators", ""},
    {&KernelFeatures::bvh, "BVH", "a few spheres alone: no BVH"},
    {&KernelFeatures::other_lights, "other lights",
     "no lights but spheres that shine: no lamps, shining meshes, suns or sky"},
    {&KernelFeatures::visibility, "ray visibility", ""},
    {&KernelFeatures::estimator_flags, "estimator flags", ""},
    {&KernelFeatures::passes, "passes", ""},
}};
inline constexpr KernelFeatures kAllFeatures{true, true, true, true, true, true, true,
                                             true, true, true, true, true, true, true};

/// Whether a kernel with the features `has` can render what needs `needed`.
constexpr bool covers(const KernelFeatures &has, const KernelFeatures &needed) {
    for (const FeatureText &f : kFeatureTexts)
        if (needed.*f.feature && !(has.*f.feature))
            return false;
    return true;
}
static_assert(sizeof(KernelFeatures) == kFeatureTexts.size(), "a feature without a row");

/// The features that a scene needs. shares: it has light vertices (plan_light_vertex_cache). passes: bit set of 1 <<
/// glimmer_pass.
KernelFeatures needed_by(const Scene &scene, const EstimatorFlags &flags, bool shares, uint64_t passes = 0);

/// What such a scene has no use for, in lines for the user.
std::vector<std::string> left_out(const KernelFeatures &needed);

} // namespace glimmer
