// SPDX-License-Identifier: GPL-3.0-or-later
// What the lobes of a BSDF add up to by their kind, for the passes that tell them apart. As in Cycles, a translucent
// lobe is a diffuse one, and a dielectric reflects as glossy lobes do.
#pragma once

#include "bsdf/bsdf.h"

namespace glimmer {

struct LobeSums {
    Rgb diffuse, glossy, transmission;
};

/// f |cos_i| of the smooth lobes for which `counts` is true.
template <class Predicate>
LobeSums eval_by_kind(const Bsdf &bsdf, const Vec3f &wo, const Vec3f &wi, const Predicate &counts) {
    LobeSums sum;
    for (const WeightedLobe &l : bsdf)
        if (counts(l.lobe))
            (is_diffuse(l.lobe) ? sum.diffuse
             : wi.z < 0         ? sum.transmission
                                : sum.glossy) += eval(l.lobe, wo, wi, bsdf.eta) * weight_towards(bsdf, l, wo);
    return sum;
}

/// About the part of the light that is sent on to wo: exact for smooth glass and Lambert's.
inline LobeSums albedo_by_kind(const Bsdf &bsdf, const Vec3f &wo) {
    LobeSums sum;
    for (const WeightedLobe &l : bsdf) {
        const float weight = weight_towards(bsdf, l, wo);
        lobes::visit(
            [&]<class T>(const T &lobe) {
                if constexpr (std::is_same_v<T, Dielectric>) {
                    const float r = reflectance(lobe, wo.z, bsdf.eta);
                    sum.glossy += lobe.reflection * ((lobe.reflects ? r : 0) * weight);
                    sum.transmission += lobe.transmission * ((1 - r) * weight);
                } else if constexpr (std::is_same_v<T, Transparent>) {
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
