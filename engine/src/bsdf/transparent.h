// SPDX-License-Identifier: GPL-3.0-or-later
// Light that goes straight through, as a lobe: only where the surface bounds a dielectric as well, whose inside it then
// leads to. Everywhere else a surface that is not opaque is no vertex of a path at all (Shading::transparency).
#pragma once

#include "bsdf/sample.h"

#include <optional>

namespace glimmer {

struct Transparent {
    Rgb transmittance;
};

inline Rgb eval(const Transparent &, const Vec3f &, const Vec3f &) {
    return {};
}
inline float pdf(const Transparent &, const Vec3f &, const Vec3f &) {
    return 0;
}
inline std::optional<BsdfSample> sample(const Transparent &lobe, const Vec3f &wo, Vec2f) {
    return BsdfSample{-wo, lobe.transmittance, 1, true, true};
}
inline bool is_specular(const Transparent &) {
    return true;
}
inline float max_value(const Transparent &) {
    return kInfinity;
}
inline Rgb albedo(const Transparent &lobe) {
    return lobe.transmittance;
}

} // namespace glimmer
