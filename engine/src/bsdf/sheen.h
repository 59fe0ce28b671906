// SPDX-License-Identifier: GPL-3.0-or-later
// Cloth's shine towards grazing angles, by one of three models.
#pragma once

#include "bsdf/fresnel.h"
#include "bsdf/ggx.h"
#include "bsdf/sample.h"
#include "sampling/warp.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

namespace glimmer {

enum class SheenModel : uint8_t {
    fibers,  ///< a layer of fibres (Zeltner, Burley, Chiang 2022, "Practical multiple-scattering sheen using linearly
             ///< transformed cosines"); not reciprocal
    schlick, ///< Schlick's weight (Burley 2012); without roughness
    velvet   ///< Ashikhmin, Premoze, Shirley 2000, "A microfacet-based BRDF generator", section 5
};

struct Sheen {
    Rgb color;
    float roughness = 1; ///< 0 to 1
    SheenModel model = SheenModel::fibers;
};

namespace fibers {

constexpr float kLeastRoughness = 0.01f; // of the fits

/// Part of the light that the fibres send towards a cosine: the fit of MaterialX to the paper's data.
inline float albedo(float cosine, float roughness) {
    const float x = cosine, y = std::max(roughness, kLeastRoughness);
    const float s = y * (0.0206607f + 1.58491f * y) / (0.0379424f + y * (1.32227f + y));
    const float m = y * (-0.193854f + y * (-1.14885f + y * (1.7932f - 0.95943f * y * y))) / (0.046391f + y);
    const float o = y * (0.000654023f + (-0.0207818f + 0.119681f * y) * y) / (1.26264f + y * (-1.92021f + y));
    const float t = (x - m) / s;
    return std::clamp(std::exp(-0.5f * t * t) / (s * std::sqrt(2 * kPi)) + o, 0.0f, 1.0f);
}

/// The matrix that takes the lobe, in the plane of wo, to a cosine's: (a x + b z, a y, z); the fits of MaterialX.
struct Transform {
    float a, b;
    Vec2f along; ///< unit: the azimuth of wo

    Transform(const Vec3f &wo, float roughness) {
        const float x = std::min(wo.z, 1.0f), y = std::max(roughness, kLeastRoughness);
        a = (2.58126f * x + 0.813703f * y) * y / (1 + 0.310327f * x * x + 2.60994f * x * y);
        b = std::sqrt(1 - x) * (y - 1) * y * y * y /
            (0.0000254053f + 1.71228f * x - 1.71506f * x * y + 1.34174f * y * y);
        const float size = std::sqrt(wo.x * wo.x + wo.y * wo.y);
        along = size > 0 ? Vec2f{wo.x / size, wo.y / size} : Vec2f{1, 0};
    }
    float density(const Vec3f &wi) const {
        const float x = along.x * wi.x + along.y * wi.y, y = along.x * wi.y - along.y * wi.x;
        const Vec3f w{a * x + b * wi.z, a * y, wi.z};
        const float scale = a / length_squared(w);
        return wi.z > 0 ? wi.z / kPi * scale * scale : 0;
    }
    Vec3f direction(Vec2f u) const {
        const Vec3f w = sample_cosine_hemisphere(u);
        const float x = (w.x - b * w.z) / a, y = w.y / a;
        return normalize(Vec3f{along.x * x - along.y * y, along.y * x + along.x * y, w.z});
    }
};

} // namespace fibers

/// f cos_i of velvet: slopes that are common away from the normal alone.
inline float velvet(float roughness, const Vec3f &wo, const Vec3f &wi) {
    const Vec3f h = half_vector(wo, wi);
    const float cos_oh = dot(wo, h), sine2 = h.x * h.x + h.y * h.y;
    if (!(wi.z > 0) || !(cos_oh > 1e-5f) || !(sine2 > 1e-6f))
        return 0;
    const float sigma = std::max(roughness, 0.01f), inverse2 = 1 / (sigma * sigma);
    const float d = std::exp(-h.z * h.z / sine2 * inverse2) * inverse2 / (kPi * sine2 * sine2);
    const float seen = std::min({1 / wo.z, 2 * h.z / cos_oh, 2 * h.z * wi.z / (cos_oh * wo.z)});
    return 0.25f * d * seen;
}

inline float pdf(const Sheen &lobe, const Vec3f &wo, const Vec3f &wi) {
    if (!(wi.z > 0))
        return 0;
    switch (lobe.model) {
    case SheenModel::fibers:
        return fibers::Transform(wo, lobe.roughness).density(wi);
    case SheenModel::schlick:
        return pdf_cosine_hemisphere(wi.z);
    case SheenModel::velvet:
        break;
    }
    return 1 / (2 * kPi);
}
inline Rgb eval(const Sheen &lobe, const Vec3f &wo, const Vec3f &wi) {
    if (!(wi.z > 0))
        return {};
    switch (lobe.model) {
    case SheenModel::fibers:
        return lobe.color * (fibers::albedo(wo.z, lobe.roughness) * fibers::Transform(wo, lobe.roughness).density(wi));
    case SheenModel::schlick:
        return lobe.color * (schlick_weight(dot(wi, half_vector(wo, wi))) * wi.z);
    case SheenModel::velvet:
        break;
    }
    return lobe.color * velvet(lobe.roughness, wo, wi);
}
inline std::optional<BsdfSample> sample(const Sheen &lobe, const Vec3f &wo, Vec2f u) {
    Vec3f wi;
    if (lobe.model == SheenModel::fibers)
        wi = fibers::Transform(wo, lobe.roughness).direction(u);
    else if (lobe.model == SheenModel::schlick)
        wi = sample_cosine_hemisphere(u);
    else {
        const Vec2f p = circle_point(std::sqrt((1 - u.y) * (1 + u.y)), u.x);
        wi = {p.x, p.y, u.y};
    }
    const float density = pdf(lobe, wo, wi);
    if (!(density > 0))
        return std::nullopt;
    return BsdfSample{wi, eval(lobe, wo, wi) / density, density, false};
}
inline bool is_specular(const Sheen &) {
    return false;
}
/// At an angle of 60 degrees.
inline Rgb albedo(const Sheen &lobe) {
    return lobe.color * (lobe.model == SheenModel::fibers ? fibers::albedo(0.5f, lobe.roughness) : 0.1f);
}
/// Part of the light towards wo that the lobe keeps from what lies beneath.
inline Rgb coverage(const Sheen &lobe, const Vec3f &wo) {
    return lobe.model == SheenModel::fibers ? lobe.color * fibers::albedo(wo.z, lobe.roughness) : Rgb();
}
/// The lobes are narrow where they are smooth and seen at grazing angles: no bound that would be of use.
inline float max_value(const Sheen &lobe) {
    return lobe.model == SheenModel::schlick ? max_component(lobe.color) : kInfinity;
}

} // namespace glimmer
