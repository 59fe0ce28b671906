// SPDX-License-Identifier: GPL-3.0-or-later
// How the path integrator spends a camera sample, by a rule that depends on the scene alone.
#pragma once

#include "integrator/path_options.h"
#include "scene/scene.h"

namespace glimmer {

/// How much the light expected (expected_light.h) at what the camera sees changes within a pixel: its variance there
/// over the square of its mean, from a pilot of pairs of camera rays. 0 without surfaces, or with more lights than are
/// weighed one by one.
double pixel_contrast(const Scene &scene);

struct PathPlan {
    uint32_t branches = 1;    ///< paths that go on from the first surface, each with its part of the light
    bool light_pixel = false; ///< several points of the pixel compete for being lit (path_pixel.h)
};

/// Surfaces glint where the contrast is above .8. There four points compete for being lit: they cost a twentieth of a
/// sample (a fifth without fog), and the light that comes straight from lights has half the variance. Where surfaces
/// glint, and in fog, whose work on the camera's ray the branches share, four of them go on; else two.
/// In samples of equal cost, the variance is .74 of what it is without competing points on glimmervoid, .78 in the
/// clearing, .81 on smooth metal, .96 on glimmervoid without fog (and 1.3, measured with roulette from the start, on a
/// field of alpha .25, whose contrast is .35); with one branch for four it is 1.8, 2.0, 1.9 and 1.3 times as large.
/// Without fog two branches give .76 of the variance of four on that field, and 1.1 on glimmervoid.
PathPlan plan_path(const Scene &scene, const PathOptions &options);

} // namespace glimmer
