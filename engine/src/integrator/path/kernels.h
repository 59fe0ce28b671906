// SPDX-License-Identifier: GPL-3.0-or-later
// The path integrator as it was compiled for sets of features.
#pragma once

#include "film/sample.h"
#include "integrator/integrator.h"
#include "integrator/path/kernel_features.h"
#include "integrator/path/splitting_plan.h"
#include "integrator/vpl/light_vertex_cache.h"

namespace glimmer {

/// What all samples of a pixel of a pass have in common.
struct PathContext {
    const Scene &scene;
    const DepthLimits &limits;
    const EstimatorFlags &options;
    const SplittingPlan &plan;
    const LightVertexBlock *pool; ///< null: plain paths
    uint32_t pixel_x, pixel_y;
    float primary_weight; ///< of the radiance of a sphere that the camera's own ray meets; other rays bring the rest
};

struct PathKernel {
    const char *name; ///< what it was compiled for, in plain words
    KernelFeatures features;
    /// The light of one camera ray that starts within the bodies `glass`.
    FilmSample (*sample)(const PathContext &work, const Ray &ray, const InteriorStack &glass, Sampler &sampler,
                         TraceContext &rays);
};

/// The first of the table that has what is needed.
const PathKernel &path_kernel(const KernelFeatures &needed);

} // namespace glimmer
