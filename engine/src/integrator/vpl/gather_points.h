// SPDX-License-Identifier: GPL-3.0-or-later
// Points of the medium that the camera sees. They stand for the gather points of a picture or of a block.
#pragma once

#include "integrator/trace_context.h"
#include "math/rectangle.h"
#include "medium/interior_stack.h"
#include "sampling/sampler.h"
#include "scene/scene.h"

#include <vector>

namespace glimmer {

/// Scattering points of the medium on `count` random camera rays through the pixels, each from another stratum of the
/// distances. Fewer where a ray's segment does not scatter; none where camera rays start within a dielectric.
std::vector<Vec3f> sample_gather_points(const Scene &scene, const Rectangle &pixels, const InteriorStack &around_camera,
                                        uint32_t count, ShutterTime time, Sampler &sampler, TraceContext &rays);

} // namespace glimmer
