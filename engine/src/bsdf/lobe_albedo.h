// SPDX-License-Identifier: GPL-3.0-or-later
// The albedo of a BSDF by the kind of its lobes, for the passes of colour.
#pragma once

#include "bsdf/bsdf.h"

namespace glimmer {

struct LobeAlbedo {
    Rgb diffuse, glossy, transmission;
};

/// About the part of the light towards wo: exact for smooth lobes and Lambert's.
inline LobeAlbedo lobe_albedo(const Bsdf &bsdf, const Vec3f &wo) {
    LobeAlbedo sum;
    for (const WeightedLobe &l : bsdf) {
        const float weight = weight_towards(bsdf, l, wo);
        std::visit(
            [&]<class T>(const T &lobe) {
                if constexpr (std::is_same_v<T, Dielectric>) {
                    const float r = reflectance(lobe, wo.z, bsdf.eta);
                    sum.glossy += lobe.reflection * ((lobe.reflects ? r : 0) * weight);
                    sum.transmission += lobe.transmission * ((1 - r) * weight);
                } else if constexpr (std::is_same_v<T, Translucent> || std::is_same_v<T, Transparent>) {
                    sum.transmission += albedo(lobe) * weight;
                } else if constexpr (std::is_same_v<T, Conductor> || std::is_same_v<T, Brushed>) {
                    sum.glossy += coverage(lobe, wo) * weight;
                } else {
                    (is_diffuse(l.lobe) ? sum.diffuse : sum.glossy) += albedo(lobe) * weight;
                }
            },
            l.lobe);
    }
    return sum;
}

} // namespace glimmer
