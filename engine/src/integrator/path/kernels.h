// SPDX-License-Identifier: GPL-3.0-or-later
// The path integrator's inner loop as it was compiled for sets of features.
#pragma once

#include "film/sample.h"
#include "integrator/depth_limits.h"
#include "integrator/path/kernel_features.h"
#include "integrator/path/splitting_plan.h"
#include "integrator/vpl/light_vertex_cache.h"

namespace glimmer {

/// What all samples of one pixel in one wave have in common.
struct PathContext {
    const Scene &scene;
    const DepthLimits &limits;
    const EstimatorFlags &flags;
    const SplittingPlan &plan;
    const LightVertexBlock *light_vertices; ///< of the pixel's block; null where paths bring all scattered light
    uint32_t pixel_x, pixel_y;
    /// Part of the radiance of an emissive sphere that the camera's own ray brings; emitter_rays.h brings the rest.
    float primary_weight;
    /// Takes what counts otherwise than the rest; null: all counts alike.
    SampleParts *parts = nullptr;
    bool ambient_occlusion = false; ///< its pass is asked for
};

struct PathKernel {
    const char *name; ///< what it was compiled for, in plain words
    KernelFeatures features;
    /// The light of one camera ray, which starts within the dielectrics `interior`.
    FilmSample (*sample)(const PathContext &context, const Ray &ray, const InteriorStack &interior, Sampler &sampler,
                         TraceContext &trace);
};

/// The light of one camera ray: kernel.inl defines it, and one file of kernels/ compiles it for each set below.
template <KernelFeatures F>
FilmSample sample_path(const PathContext &context, const Ray &ray, const InteriorStack &interior, Sampler &sampler,
                       TraceContext &trace);

template <KernelFeatures F>
constexpr PathKernel compiled(const char *name) {
    return {name, F, &sample_path<F>};
}

constexpr KernelFeatures without_passes(KernelFeatures features) {
    features.passes = false;
    return features;
}

// The sets of features that a kernel is compiled for.
inline constexpr KernelFeatures kSpheres{.medium = true};
inline constexpr KernelFeatures kSurfaces{.surfaces = true, .terminators = true, .bvh = true};
inline constexpr KernelFeatures kSurfacesInFog{.medium = true, .surfaces = true, .terminators = true, .bvh = true};
inline constexpr KernelFeatures kEverythingButPasses = without_passes(kAllFeatures);

/// The first kernel of the table, least features first, that has what is needed.
const PathKernel &path_kernel(const KernelFeatures &needed);

} // namespace glimmer
