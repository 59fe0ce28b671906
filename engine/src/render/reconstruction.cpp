// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/reconstruction.h"

namespace glimmer {

const char *reason_against_reconstruction(const Scene &scene, const RenderSettings &settings) {
    const uint32_t pixels = scene.film.filter.reach();
    if (pixels == 0) // what samples count for is the same then
        return nullptr;
    if (settings.adaptive) // the weights that meet in a pixel would not sum to 1
        return "sampling is adaptive";
    if (pixels > FilterWeights::kMostReach)
        return "the filter is wider than 5 pixels";
    if (settings.independent_pixels)
        return "pixels are to be independent, as denoisers need it";
    return nullptr;
}

FilmReach film_reach(const Scene &scene, const Integrator &integrator, const RenderSettings &settings) {
    const FilmSettings &film = scene.film;
    if (!integrator.reconstructs() || reason_against_reconstruction(scene, settings) || film.filter.reach() == 0)
        return {};
    return {film.filter.reach(), film.crop_x, film.crop_y};
}

} // namespace glimmer
