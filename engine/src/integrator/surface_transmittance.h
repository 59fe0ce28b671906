// SPDX-License-Identifier: GPL-3.0-or-later
// How much light surfaces that are not opaque let straight through between two points.
#pragma once

#include "integrator/trace_context.h"
#include "scene/scene.h"

namespace glimmer {

/// What passes along the ray up to its t_max, which something stands in the way of: the product of the transparencies
/// of all surfaces there, black if one is opaque. Surfaces that bound a dielectric are opaque to straight rays, however
/// transparent: paths that pass one go on inside another body, and are what brings that light. ignored_sphere: the
/// light that the ray aims at, where it ends. Asked only where Scene::has_transparency.
Rgb surface_transmittance(const Scene &scene, Ray ray, uint32_t ignored_sphere, TraceContext &rays);

} // namespace glimmer
