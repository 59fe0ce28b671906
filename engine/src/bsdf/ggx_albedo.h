// SPDX-License-Identifier: GPL-3.0-or-later
// How much light GGX facets send on, by the direction that it leaves in: tables, since no closed form is known. They
// are computed where first asked for, in some hundredths of a second.
//
// Facets shadow light that others of them send up, and a lobe of single scattering loses it. Dividing the lobe by its
// directional albedo makes up for that (Turquin 2019, "Practical multiple scattering compensation for microfacet
// models"), which is what Cycles does from 4.0 on. The factor knows the side of wo alone: such a lobe is not
// reciprocal.
#pragma once

#include "math/vec.h"

namespace glimmer {

/// Part of the light that a rough mirror sends on when scattered once: of directions of this cosine, and its mean over
/// cosine-weighted ones. alpha: GGX width, 0 to 1.
float ggx_albedo(float cosine, float alpha);
float mean_ggx_albedo(float alpha);

/// Mean of (F - F0) / (1 - F0) over the facets that reflect light to this cosine, F being the reflectance between
/// dielectrics and F0 that at normal incidence: where between f0 and f90 the reflectance of a rough dielectric is.
float mean_fresnel_rise(float cosine, float alpha, float ior);

/// Part of the light that a rough boundary of a dielectric sends on when scattered once, reflected or transmitted: of
/// directions of this cosine, and its mean over cosine-weighted ones.
float ggx_dielectric_albedo(float cosine, float alpha, float eta);
float mean_ggx_dielectric_albedo(float alpha, float eta);

/// What a lobe of single scattering is to be multiplied by, so that it keeps the light that facets send on to each
/// other. albedo, mean_albedo: of white facets. color: of a facet, over all directions (Kulla and Conty 2017,
/// "Revisiting physically based shading at Imageworks").
inline Rgb multiple_scattering_scale(float albedo, float mean_albedo, const Rgb &color) {
    const float missing = (1 - albedo) / albedo;
    Rgb scale;
    for (int c = 0; c < 3; ++c)
        scale[c] = 1 + color[c] * mean_albedo / (1 - color[c] * (1 - mean_albedo)) * missing;
    return scale;
}
/// No directional albedo of the tables is below its inverse.
inline float max_multiple_scattering_scale(float alpha) {
    return 1.2f + 2.3f * alpha;
}

} // namespace glimmer
