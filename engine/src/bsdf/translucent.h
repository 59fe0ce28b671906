// SPDX-License-Identifier: GPL-3.0-or-later
// Diffuse transmission: Lambert's lobe on the other side.
#pragma once

#include "bsdf/sample.h"
#include "sampling/warp.h"

#include <optional>

namespace glimmer {

struct Translucent {
    Rgb albedo;
};

inline Rgb eval(const Translucent &lobe, const Vec3f &, const Vec3f &wi) {
    return lobe.albedo * pdf_cosine_hemisphere(-wi.z);
}
inline float pdf(const Translucent &, const Vec3f &, const Vec3f &wi) {
    return pdf_cosine_hemisphere(-wi.z);
}
inline std::optional<BsdfSample> sample(const Translucent &lobe, const Vec3f &, Vec2f u) {
    Vec3f wi = sample_cosine_hemisphere(u);
    if (!(wi.z > 0))
        return std::nullopt;
    wi.z = -wi.z;
    return BsdfSample{wi, lobe.albedo, pdf_cosine_hemisphere(-wi.z), false, true};
}
inline bool is_specular(const Translucent &) {
    return false;
}
inline Rgb albedo(const Translucent &lobe) {
    return lobe.albedo;
}
/// No f cos_o of any channel is larger.
inline float max_value(const Translucent &lobe) {
    return max_component(lobe.albedo) / kPi;
}

} // namespace glimmer
