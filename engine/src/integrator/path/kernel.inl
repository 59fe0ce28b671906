// SPDX-License-Identifier: GPL-3.0-or-later
// All steps of the path integrator together, to be compiled for a set of features.
#pragma once

#include "integrator/path/kernels.h"
#include "integrator/path/medium.inl"
#include "integrator/path/pixel_ris.inl"
#include "integrator/path/segment.inl"
#include "integrator/path/surface.inl"
#include "integrator/path/vpl_gather.inl"

namespace glimmer {

/// Flattened: every call into a header is inlined, which the compiler would not do for so large a function by itself.
template <KernelFeatures F>
[[gnu::flatten]] FilmSample sample_path(const PathContext &work, const Ray &ray, const InteriorStack &glass,
                                        Sampler &sampler, TraceContext &rays) {
    PathState<F> camera;
    camera.ray = ray;
    if constexpr (F.glass)
        camera.glass = glass;
    return PathSample<F>(work, sampler, rays).run(camera);
}

template <KernelFeatures F>
constexpr PathKernel compiled(const char *name) {
    return {name, F, &sample_path<F>};
}

} // namespace glimmer
