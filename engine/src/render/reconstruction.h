// SPDX-License-Identifier: GPL-3.0-or-later
// Whether the samples of a render count for every pixel whose filter holds them (docs/method.md, section 18), or each
// for one pixel alone, drawn by the pixel's filter.
#pragma once

#include "film/film_layout.h"
#include "integrator/integrator.h"
#include "render/render_settings.h"
#include "scene/scene.h"

namespace glimmer {

/// Why they do not, though the filter is wider than a pixel and the integrator would; null else.
const char *reason_against_reconstruction(const Scene &scene, const RenderSettings &settings);

/// How far they count; nothing where each counts for one pixel.
FilmReach film_reach(const Scene &scene, const Integrator &integrator, const RenderSettings &settings);

} // namespace glimmer
