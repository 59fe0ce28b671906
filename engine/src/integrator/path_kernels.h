// SPDX-License-Identifier: GPL-3.0-or-later
// The path integrator as it was compiled for sets of features.
#pragma once

#include "film/sample.h"
#include "integrator/features.h"
#include "integrator/integrator.h"
#include "integrator/light_pool.h"
#include "integrator/path_plan.h"

namespace glimmer {

/// What all samples of a pixel of a pass have in common.
struct PathWork {
    const Scene &scene;
    const DepthLimits &limits;
    const PathOptions &options;
    const PathPlan &plan;
    const LightPoolBlock *pool; ///< null: plain paths
    uint32_t pixel_x, pixel_y;
    float seen_part; ///< of the radiance of a sphere that the camera's own ray meets; other rays bring the rest
};

struct PathKernel {
    const char *name; ///< what it was compiled for, in plain words
    Features features;
    /// The light of one camera ray that starts within the bodies `glass`.
    FilmSample (*sample)(const PathWork &work, const Ray &ray, const GlassStack &glass, Sampler &sampler,
                         RayCounter &rays);
};

/// The first of the table that has what is needed.
const PathKernel &path_kernel(const Features &needed);

} // namespace glimmer
