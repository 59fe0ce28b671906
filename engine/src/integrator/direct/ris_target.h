// SPDX-License-Identifier: GPL-3.0-or-later
// About how much light a surface throws at the viewer straight from the scene's lights, were nothing in the way: what
// points are chosen by where one of several is to be lit (never what they bring).
#pragma once

#include "scene/scene.h"

namespace glimmer {

/// wo: unit, away from the surface. sigma: the least extinction of the channels. Lambert lobes count the light's
/// middle; narrow ones the point of a sphere that is nearest to the mirrored ray, their peak lowered by what the
/// light's width adds to theirs (Karis 2013, "Real Shading in Unreal Engine 4": representative points). Lights at
/// infinity count as if they shone from all sides. 0 for glass and where nothing is rough.
float ris_target(const Scene &scene, const Interaction &surface, Bsdf bsdf, const Vec3f &wo, float sigma);

} // namespace glimmer
