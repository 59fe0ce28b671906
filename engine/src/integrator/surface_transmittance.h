// SPDX-License-Identifier: GPL-3.0-or-later
// How much light surfaces that are not opaque let straight through between two points.
#pragma once

#include "integrator/trace_context.h"
#include "scene/scene.h"

namespace glimmer {

/// The fraction of light that passes along a ray with surfaces in its way up to t_max: the product of their
/// transparencies, black if one is opaque. Surfaces that bound a dielectric are opaque to straight rays, however
/// transparent: paths that pass one go on inside another body, and are what brings that light. ignored_sphere: the
/// light that the ray aims at, where it ends. Asked only where Scene::has_transparency.
Rgb surface_transmittance(const Scene &scene, Ray ray, RayKind kind, uint32_t ignored_sphere, TraceContext &rays);

} // namespace glimmer
