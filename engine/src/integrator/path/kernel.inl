// SPDX-License-Identifier: GPL-3.0-or-later
// All steps of the path integrator together, to be compiled for a set of features. Only the files of kernels/, and
// benchmarks of single kernels, may include this.
#pragma once

#include "integrator/path/kernels.h"
#include "integrator/path/medium.inl"
#include "integrator/path/passes.inl"
#include "integrator/path/pixel_ris.inl"
#include "integrator/path/segment.inl"
#include "integrator/path/surface.inl"
#include "integrator/path/vpl_gather.inl"

namespace glimmer {

/// Flattened: every call of an inline function is inlined, which the compiler would not do for so large a function by
/// itself.
template <KernelFeatures F>
[[gnu::flatten]] FilmSample sample_path(const PathContext &context, const Ray &ray, const InteriorStack &interior,
                                        Sampler &sampler, TraceContext &trace) {
    PathState<F> camera;
    camera.ray = ray;
    if constexpr (F.transmission)
        camera.interior = interior;
    return PathSample<F>(context, sampler, trace).run(camera);
}

} // namespace glimmer
