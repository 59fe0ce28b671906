// SPDX-License-Identifier: GPL-3.0-or-later
// A bound on what a path far outside the scene can still bring.
#pragma once

#include "scene/scene.h"

namespace glimmer {

/// A factor for Russian roulette: 1 within a mean free path of the scene's bounds; beyond, the probability that a
/// random walk from distance r returns to that radius R, (R/r)^2 e^(-kappa (r - R)), with kappa the effective
/// attenuation of the channel that carries light furthest. Without it, a path in an endless medium of albedo 1 would
/// never end. Only the survival probability depends on it, so an inaccurate value costs noise but never a bias.
float return_bound(const Scene &scene, const Vec3f &x);

} // namespace glimmer
