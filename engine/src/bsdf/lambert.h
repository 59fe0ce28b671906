// SPDX-License-Identifier: GPL-3.0-or-later
// Diffuse reflection.
#pragma once

#include "bsdf/sample.h"
#include "sampling/warp.h"

#include <optional>

namespace glimmer {

struct Lambert {
    Rgb albedo;
};

inline Rgb eval(const Lambert &lobe, const Vec3f &, const Vec3f &wi) {
    return lobe.albedo * pdf_cosine_hemisphere(wi.z);
}
inline float pdf(const Lambert &, const Vec3f &, const Vec3f &wi) {
    return pdf_cosine_hemisphere(wi.z);
}
inline std::optional<BsdfSample> sample(const Lambert &lobe, const Vec3f &, Vec2f u) {
    const Vec3f wi = sample_cosine_hemisphere(u);
    if (!(wi.z > 0))
        return std::nullopt;
    return BsdfSample{wi, lobe.albedo, pdf_cosine_hemisphere(wi.z), false};
}
inline bool is_specular(const Lambert &) {
    return false;
}
inline Rgb albedo(const Lambert &lobe) {
    return lobe.albedo;
}
/// No f cos_o of any channel is larger.
inline float max_value(const Lambert &lobe) {
    return max_component(lobe.albedo) / kPi;
}

} // namespace glimmer
