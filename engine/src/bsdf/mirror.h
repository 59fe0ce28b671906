// SPDX-License-Identifier: GPL-3.0-or-later
// Specular reflection of a constant fraction.
#pragma once

#include "bsdf/sample.h"

#include <optional>

namespace glimmer {

struct Mirror {
    Rgb reflectance;
};

inline Rgb eval(const Mirror &, const Vec3f &, const Vec3f &) {
    return {};
}
inline float pdf(const Mirror &, const Vec3f &, const Vec3f &) {
    return 0;
}
inline std::optional<BsdfSample> sample(const Mirror &lobe, const Vec3f &wo, Vec2f) {
    return BsdfSample{{-wo.x, -wo.y, wo.z}, lobe.reflectance, 1, true};
}
inline bool is_specular(const Mirror &) {
    return true;
}
inline float max_value(const Mirror &) {
    return kInfinity;
}
inline Rgb albedo(const Mirror &lobe) {
    return lobe.reflectance;
}

} // namespace glimmer
