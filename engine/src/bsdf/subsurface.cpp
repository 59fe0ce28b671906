// SPDX-License-Identifier: GPL-3.0-or-later
#include "bsdf/subsurface.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace glimmer {

namespace {

/// Of a half-space of this albedo that light enters by cosine, whose scattering has the mean cosine g: the albedo of
/// single scattering (d'Eon, "A Hitchhiker's Guide to Multiple Scattering", equation 53.7).
float albedo_of_single_scattering(float albedo, float g) {
    const float s = 4.20863f * albedo - std::sqrt(9.59217f + albedo * (41.6808f + 17.7126f * albedo)) + 4.09712f;
    return (1 - s * s) / (1 - g * s * s);
}

float polynomial(const std::array<float, 8> &c, float x) {
    float sum = 0;
    for (size_t i = c.size(); i-- > 0;)
        sum = sum * x + c[i];
    return sum;
}

/// The same, by the fit of Wrenninge, Villemin, Hery 2017 ("Path Traced Subsurface Scattering using Anisotropic Phase
/// Functions and Non-Exponential Free Flights"), for g in [0, .9].
float fitted_albedo_of_single_scattering(float albedo, float g) {
    const float a = polynomial({1.8260523782f, -1.28451056436f, -1.79904629312f, 9.19393289202f, -22.8215585862f,
                                32.0234874259f, -23.6264803333f, 7.21067002658f},
                               g);
    const float b =
        4.98511194385f +
        0.127355959438f * std::exp(polynomial({0, 31.1491581433f, -201.847017512f, 841.576016723f, -2018.09288505f,
                                               2731.71560286f, -1935.41424244f, 559.009054474f},
                                              g));
    const float c = polynomial({1.09686102424f, -0.394704063468f, 1.05258115941f, -8.83963712726f, 28.8643230661f,
                                -46.8802913581f, 38.5402837518f, -12.7181042538f},
                               g);
    const float d = polynomial({0.496310210422f, 0.360146581622f, -2.15139309747f, 17.8896899217f, -55.2984010333f,
                                82.065982243f, -58.5106008578f, 15.8478295021f},
                               g);
    const float e =
        4.23190299701f +
        0.00310603949088f * std::exp(polynomial({0, 76.7316253952f, -594.356773233f, 2448.8834203f, -5576.68528998f,
                                                 7116.60171912f, -4763.54467887f, 1303.5318055f},
                                                g));
    const float f = polynomial({2.40602999408f, -2.51814844609f, 9.18494908356f, -79.2191708682f, 259.082868209f,
                                -403.613804597f, 302.85712436f, -87.4370473567f},
                               g);
    const float blend = std::pow(albedo, 0.25f);
    return (1 - blend) * a * std::pow(std::atan(b * albedo), c) + blend * d * std::pow(std::atan(e * albedo), f);
}

/// The factor from the distance over which a dipole spreads light to the mean free path: sqrt(3 (1 - a')) of the
/// reduced albedo a' that gives the dipole (Jensen, Marschner, Levoy, Hanrahan 2001) the total reflectance `albedo`.
float dipole_radius_scale(float albedo, float ior) {
    if (albedo >= 0.995f)
        return std::sqrt(3 * 1e-6f);
    const float inner = -1.44f / (ior * ior) + 0.71f / ior + 0.668f + 0.0636f * ior;
    const float a = 4.0f / 3 * (1 + inner) / (1 - inner);
    float low = 0, high = 1;
    constexpr int kHalvings = 12;
    for (int i = 0; i < kHalvings && albedo >= 1e-4f; ++i) {
        const float reduced = (low + high) / 2, s = std::sqrt(3 * (1 - reduced));
        (reduced / 2 * (1 + std::exp(-a * s)) * std::exp(-s) < albedo ? low : high) = reduced;
    }
    return std::sqrt(3 * (1 - (low + high) / 2 * (albedo >= 1e-4f ? 1.0f : 0.0f)));
}

float mean_free_path(const Subsurface &lobe, float radius, float albedo, float g) {
    switch (lobe.model) {
    case SubsurfaceModel::random_walk:
        return radius;
    case SubsurfaceModel::fixed_radius:
        return radius / (4 * kPi) * (g < 0 ? 1 : 1 - g);
    case SubsurfaceModel::skin:
        break;
    }
    return radius * dipole_radius_scale(albedo, lobe.ior) * (g < 0 ? 1 : 1 - g);
}

} // namespace

SubsurfaceMedium subsurface_medium(const Subsurface &lobe) {
    constexpr float kMostAlpha = 0.999999f; // so that every walk ends
    constexpr float kLeastAlpha = 0.2f;     // darker, the light that enters is cut in place of it
    constexpr float kMostFittedG = 0.9f;
    const bool fitted = lobe.model != SubsurfaceModel::random_walk && lobe.anisotropy >= 0;
    SubsurfaceMedium out;
    out.g = std::clamp(lobe.anisotropy, -0.99f, fitted ? kMostFittedG : 0.99f);
    for (int c = 0; c < 3; ++c) {
        const float albedo = lobe.albedo[c];
        const float alpha =
            fitted ? fitted_albedo_of_single_scattering(albedo, out.g) : albedo_of_single_scattering(albedo, out.g);
        const float cut = alpha > 0 ? std::min(alpha, kMostAlpha) : 0; // and of NaN
        out.alpha[c] = std::max(cut, kLeastAlpha);
        out.weight[c] = albedo > 0 ? std::min(cut / kLeastAlpha, 1.0f) : 0;
        out.sigma_t[c] = 1 / std::max(mean_free_path(lobe, lobe.radius[c], albedo, out.g), 1e-16f);
    }
    return out;
}

} // namespace glimmer
