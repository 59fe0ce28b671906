// SPDX-License-Identifier: GPL-3.0-or-later
// What a point's place in the scene says about a path there.
#pragma once

#include "medium/interior_stack.h"
#include "scene/scene.h"

namespace glimmer {

/// A bound on what a path in endless medium can still bring, relative to one among the lights: 1 inside the bounds of
/// the scene, beyond them falling with the chance of a random walk's return, (R/r)^2 e^(-kappa (r - R)). Used in
/// Russian roulette alone, so it need not be right; without it a path in endless medium of albedo 1 has no end.
float return_bound(const Scene &scene, const Vec3f &x);

/// The glass bodies around a point, outermost first, found by following one ray out of them.
InteriorStack dielectrics_at(const Scene &scene, const Vec3f &x);

} // namespace glimmer
