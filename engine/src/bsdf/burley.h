// SPDX-License-Identifier: GPL-3.0-or-later
// Diffuse reflection of Disney's principled shader (Burley 2012, "Physically based shading at Disney", section 5.3):
// darker at grazing angles where it is smooth, brighter where it is rough. Not energy conserving.
#pragma once

#include "bsdf/fresnel.h"
#include "bsdf/ggx.h"
#include "bsdf/sample.h"
#include "sampling/warp.h"

#include <algorithm>
#include <optional>

namespace glimmer {

/// The lobe is the sum of a part that knows no roughness and one that rough surfaces send back to where light comes
/// from.
enum class BurleyPart : uint8_t { whole, base, retro };

struct Burley {
    Rgb albedo;
    float roughness = 0; ///< 0 to 1
    BurleyPart part = BurleyPart::whole;
};

/// Times the cosine and 1/pi.
inline float burley_part(const Burley &lobe, float cos_o, float cos_i, float cos_h) {
    const float o = schlick_weight(cos_o), i = schlick_weight(cos_i);
    if (lobe.part == BurleyPart::base)
        return (1 - 0.5f * o) * (1 - 0.5f * i);
    const float back = 2 * lobe.roughness * cos_h * cos_h;
    return back * (o + i + o * i * (back - 1));
}

inline Rgb eval(const Burley &lobe, const Vec3f &wo, const Vec3f &wi) {
    if (!(wi.z > 0))
        return {};
    const float cos_h = dot(wi, half_vector(wo, wi)), f90 = 0.5f + 2 * lobe.roughness * cos_h * cos_h;
    if (lobe.part != BurleyPart::whole)
        return lobe.albedo * (burley_part(lobe, wo.z, wi.z, cos_h) * pdf_cosine_hemisphere(wi.z));
    const auto rise = [f90](float cosine) { return 1 + (f90 - 1) * schlick_weight(cosine); };
    return lobe.albedo * (rise(wo.z) * rise(wi.z) * pdf_cosine_hemisphere(wi.z));
}
inline float pdf(const Burley &, const Vec3f &, const Vec3f &wi) {
    return pdf_cosine_hemisphere(wi.z);
}
inline std::optional<BsdfSample> sample(const Burley &lobe, const Vec3f &wo, Vec2f u) {
    const Vec3f wi = sample_cosine_hemisphere(u);
    const float density = pdf_cosine_hemisphere(wi.z);
    if (!(density > 0))
        return std::nullopt;
    return BsdfSample{wi, eval(lobe, wo, wi) / density, density, false};
}
inline bool is_specular(const Burley &) {
    return false;
}
inline Rgb albedo(const Burley &lobe) {
    constexpr float kSentBack = 0.1f; // about what the part is of the whole
    return lobe.part == BurleyPart::retro ? lobe.albedo * (kSentBack * lobe.roughness) : lobe.albedo;
}
/// No f cos_o of any channel is larger.
inline float max_value(const Burley &lobe) {
    const float back = 2 * lobe.roughness;
    if (lobe.part == BurleyPart::retro)
        return max_component(lobe.albedo) * back * std::max(2.0f, 1 + back) / kPi;
    const float f90 = std::max(1.0f, 0.5f + 2 * lobe.roughness);
    return max_component(lobe.albedo) * f90 * f90 / kPi;
}

} // namespace glimmer
