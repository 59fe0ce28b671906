// SPDX-License-Identifier: GPL-3.0-or-later
// Fresnel reflectance of unpolarised light at a smooth boundary.
#pragma once

#include "math/vec.h"

#include <algorithm>
#include <cmath>

namespace glimmer {

/// Exact, for one channel. cos_i in [0, 1]; eta > 0 and k >= 0 relative to the outside. With a + ib = sqrt((eta + ik)^2
/// - sin^2) (Born and Wolf, section 14.2). The branches keep a and b from cancelling; multiplying out the tangent keeps
/// grazing finite.
inline float fresnel_conductor(float cos_i, float eta, float k) {
    const float c2 = cos_i * cos_i, s2 = std::max(0.0f, (1 - cos_i) * (1 + cos_i));
    const float difference = (eta - k) * (eta + k) - s2; // a^2 - b^2
    const float product = eta * k;                       // a b
    const float sum = std::sqrt(difference * difference + 4 * product * product);
    float a, b;
    if (difference >= 0) {
        a = std::sqrt((sum + difference) / 2);
        b = a > 0 ? product / a : 0;
    } else {
        b = std::sqrt((sum - difference) / 2);
        a = product / b;
    }
    const float denominator = (a + cos_i) * (a + cos_i) + b * b;
    if (!(denominator > 0))
        return 1; // grazing at an index that leaves nothing behind
    const float r_s = ((a - cos_i) * (a - cos_i) + b * b) / denominator;
    const float minus = a * cos_i - s2, plus = a * cos_i + s2, b2c2 = b * b * c2;
    const float r_p = r_s * ((minus * minus + b2c2) / (plus * plus + b2c2));
    return (r_s + r_p) / 2;
}
inline Rgb fresnel_conductor(float cos_i, const Rgb &eta, const Rgb &k) {
    return {fresnel_conductor(cos_i, eta.r, k.r), fresnel_conductor(cos_i, eta.g, k.g),
            fresnel_conductor(cos_i, eta.b, k.b)};
}

/// Exact, between dielectrics. cos_i in [0, 1] on the side of the light; eta = n on the far side / n on the near side;
/// 1 in total reflection. With g = eta cos_t = sqrt(cos_i^2 + eta^2 - 1) the differences of the textbook form, which
/// cancel near eta = 1 (at 1.0001, R = 2.5e-9), become e = (eta - 1)(eta + 1) over sums.
inline float fresnel_dielectric(float cos_i, float eta) {
    const float e = (eta - 1) * (eta + 1);
    const float g2 = cos_i * cos_i + e;
    if (e == 0)
        return 0;
    if (!(g2 > 0))
        return 1;
    const float g = std::sqrt(g2), sum = cos_i + g;
    const float r_s = e / (sum * sum);
    const float r_p = e * (cos_i * sum - 1) / (sum * (eta * eta * cos_i + g));
    return std::min(1.0f, (r_s * r_s + r_p * r_p) / 2);
}

/// Schlick's approximation (1994).
inline float schlick_weight(float cos_i) {
    const float x = std::clamp(1 - cos_i, 0.0f, 1.0f), x2 = x * x;
    return x2 * x2 * x;
}
/// f90: at grazing; 1 for real metals, f0 for a reflectance that no angle changes.
inline Rgb fresnel_schlick(float cos_i, const Rgb &f0, const Rgb &f90 = Rgb(1)) {
    return f0 + (f90 - f0) * schlick_weight(cos_i);
}

/// The exact reflectance between dielectrics as a curve from 0 at normal incidence to 1 at grazing: (F - F0) / (1 -
/// F0).
inline float fresnel_rise(float cos_i, float eta) {
    const float r = (eta - 1) / (eta + 1), f0 = r * r;
    return f0 < 1 ? std::clamp((fresnel_dielectric(cos_i, eta) - f0) / (1 - f0), 0.0f, 1.0f) : 1.0f;
}

/// Reflectance of a dielectric over all directions from outside, weighted by their cosines (fits of Kulla and Conty
/// 2017).
inline float mean_fresnel_dielectric(float eta) {
    return eta < 1 ? 0.997118f + eta * (0.1014f - eta * (0.965241f + eta * 0.130607f))
                   : (eta - 1) / (4.08567f + 1.00071f * eta);
}

/// How far below Schlick's curve a metal is near 82 degrees, where cos = 1/7: Schlick's times f82 there (Kutz, Hasan,
/// Edmondson 2021, "Novel aspects of the Adobe Standard Material"). The curve is Schlick's less this times
/// cos (1 - cos)^6.
inline Rgb fresnel_f82_dip(const Rgb &f0, const Rgb &f90, const Rgb &f82) {
    constexpr float kCos = 1.0f / 7, kRest2 = (1 - kCos) * (1 - kCos), kShape = kCos * kRest2 * kRest2 * kRest2;
    return fresnel_schlick(kCos, f0, f90) * (Rgb(1) - f82) * (1 / kShape);
}

/// Schlick's approximation between dielectrics: the cosine is taken on the rarer side, so that it joins total
/// reflection.
inline float fresnel_dielectric_schlick(float cos_i, float eta) {
    const float g2 = cos_i * cos_i + (eta - 1) * (eta + 1);
    if (eta == 1)
        return 0;
    if (!(g2 > 0))
        return 1;
    const float r = (eta - 1) / (eta + 1), f0 = r * r;
    return f0 + (1 - f0) * schlick_weight(eta < 1 ? std::sqrt(g2) / eta : cos_i);
}

} // namespace glimmer
