// SPDX-License-Identifier: GPL-3.0-or-later
// All steps of the path integrator together, to be compiled for a set of features.
#pragma once

#include "integrator/path_fog.h"
#include "integrator/path_kernels.h"
#include "integrator/path_pixel.h"
#include "integrator/path_segment.h"
#include "integrator/path_surface.h"
#include "integrator/path_vertices.h"

namespace glimmer {

/// Flattened: every call into a header is inlined, which the compiler would not do for so large a function by itself.
template <Features F>
[[gnu::flatten]] FilmSample sample_path(const PathWork &work, const Ray &ray, const GlassStack &glass, Sampler &sampler,
                                        RayCounter &rays) {
    PathState<F> camera;
    camera.ray = ray;
    if constexpr (F.glass)
        camera.glass = glass;
    return PathSample<F>(work, sampler, rays).run(camera);
}

template <Features F>
constexpr PathKernel compiled(const char *name) {
    return {name, F, &sample_path<F>};
}

} // namespace glimmer
