// SPDX-License-Identifier: GPL-3.0-or-later
// Which dielectric bodies enclose a point.
#pragma once

#include "medium/interior_stack.h"
#include "scene/scene.h"

namespace glimmer {

/// The dielectric bodies around x, outermost first, found by following one ray out of the scene and noting every body
/// that it leaves without having entered it.
InteriorStack dielectrics_at(const Scene &scene, const Vec3f &x, ShutterTime time, RayKind kind);

} // namespace glimmer
