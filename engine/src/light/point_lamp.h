// SPDX-License-Identifier: GPL-3.0-or-later
// A lamp without size, or a spot of that kind.
#pragma once

#include "light/emission.h"
#include "light/interface.h"
#include "light/spot_cone.h"
#include "sampling/warp.h"

namespace glimmer {

struct PointLamp {
    Vec3f position;
    Rgb intensity;
    std::optional<SpotCone> cone;

    static constexpr LightTraits traits{.delta = true};
};

inline std::optional<LightSample> sample(const PointLamp &light, const Vec3f &x, Vec2f) {
    const Vec3f to_light = light.position - x;
    const float distance = length(to_light);
    if (!(distance > 0))
        return std::nullopt;
    const Vec3f direction = to_light / distance;
    const float factor = falloff(light.cone, -direction);
    if (factor == 0)
        return std::nullopt;
    return LightSample{direction, distance, light.intensity * (factor / distance / distance), 1, true};
}

inline Emission emit(const PointLamp &light, bool, Vec2f, const EmissionDirection &to, float) {
    const auto [direction, weight] = emission_direction(light.cone, to);
    return {{light.position, direction, {}}, light.intensity * weight};
}

inline LightBound bound(const PointLamp &light) {
    return {light.position, 0, false, mean_component(light.intensity)};
}

} // namespace glimmer
