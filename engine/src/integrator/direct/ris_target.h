// SPDX-License-Identifier: GPL-3.0-or-later
// The target function of the resampled direct light of a pixel (../path/pixel_ris.inl): about how much light a surface
// reflects towards the viewer straight from the scene's lights, if nothing stands between. It decides which candidate
// is lit, never how much light it brings.
#pragma once

#include "scene/scene.h"

namespace glimmer {

/// wo: unit, away from the surface. sigma: extinction of the channel that has the least, per length. For diffuse lobes
/// a light counts at its centre; for glossy ones at the point of its sphere nearest to the mirrored ray, with the lobe
/// widened by the light (representative points: Karis 2013, "Real Shading in Unreal Engine 4"). Lights at infinity
/// count as if they came from all sides. 0 where nothing is rough.
float ris_target(const Scene &scene, const Interaction &surface, const Bsdf &bsdf, const Vec3f &wo, float sigma);

} // namespace glimmer
