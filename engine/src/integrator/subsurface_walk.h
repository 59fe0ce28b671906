// SPDX-License-Identifier: GPL-3.0-or-later
// The way of light beneath a surface, from where it enters a body to where it leaves it.
#pragma once

#include "bsdf/subsurface.h"
#include "integrator/trace_context.h"
#include "sampling/sampler.h"
#include "scene/scene.h"

#include <optional>

namespace glimmer {

struct SubsurfaceExit {
    Interaction surface;
    Vec3f outward; ///< the geometric normal on the side that the light leaves to
    Rgb weight;
};

/// A random walk through the body that `entry` is on, as if it were filled evenly and nothing else were in it. Nothing
/// where it was absorbed. Without bias but for the switch to isotropic scattering, which is the model's own.
/// outward: the geometric normal there on the side that the light comes from. direction: into the body. beta: what the
/// channels weigh.
std::optional<SubsurfaceExit> walk_beneath(const Scene &scene, const Subsurface &lobe, const Interaction &entry,
                                           const Vec3f &outward, const Vec3f &direction, const Rgb &beta,
                                           ShutterTime time, Sampler &sampler, TraceContext &trace);

} // namespace glimmer
