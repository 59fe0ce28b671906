// SPDX-License-Identifier: GPL-3.0-or-later
// Light subpaths (docs/method.md, section 6): traced from the lights for all pixels of a wave, they leave vertices
// wherever the medium or a rough surface scatters them.
#pragma once

#include "integrator/trace_context.h"
#include "integrator/vpl/importance_map.h"
#include "integrator/vpl/light_vertices.h"
#include "integrator/vpl/vpl_settings.h"

namespace glimmer {

/// Traces settings.paths light subpaths. The mean over waves of the vertices' power, in any region, is the power that
/// is scattered there. Fewer subpaths, and of no use, once the trace is stopped.
LightVertices trace_light_subpaths(const Scene &scene, const ImportanceMap &importance, const VplSettings &settings,
                                   ShutterTime time, Sampler &sampler, TraceContext &rays);

} // namespace glimmer
