// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/light.h"

namespace glimmer {

std::optional<LightSample> sample_light(const Light &light, const Vec3f &x, Vec2f u) {
    return std::visit([&](const auto &l) { return sample(l, x, u); }, light);
}

float light_pdf(const Light &light, const Vec3f &x, const Vec3f &direction, const LightHit &hit) {
    return std::visit(
        [&](const auto &l) {
            if constexpr (std::decay_t<decltype(l)>::traits.delta)
                return 0.0f;
            else
                return pdf(l, x, direction, hit);
        },
        light);
}

std::optional<LampHit> intersect_lamp(const Light &light, const Ray &ray) {
    return std::visit(
        [&](const auto &l) -> std::optional<LampHit> {
            if constexpr (std::decay_t<decltype(l)>::traits.intersectable)
                return intersect(l, ray);
            else
                return std::nullopt;
        },
        light);
}

Rgb radiance_from_infinity(const Light &light, const Vec3f &direction, uint8_t ray) {
    return std::visit(
        [&](const auto &l) {
            if constexpr (std::decay_t<decltype(l)>::traits.infinite)
                return radiance_at_infinity(l, direction, ray);
            else
                return Rgb();
        },
        light);
}

LightBound bound_light(const Light &light) {
    return std::visit([](const auto &l) { return bound(l); }, light);
}

Vec3f lamp_normal(const Light &light, const Vec3f &position, const Vec3f &wo) {
    if (const auto *area = std::get_if<AreaLamp>(&light))
        return Vec3f(area->normal);
    if (const auto *sphere = std::get_if<SphereLamp>(&light)) {
        const Vec3d from_center = Vec3d(position) - sphere->sphere.center;
        if (length_squared(from_center) > 0)
            return Vec3f(normalize(from_center));
    }
    return wo;
}

std::optional<Emission> sample_emission(const Light &light, bool inwards, Vec2f u_position, const EmissionDirection &to,
                                        float u_choice) {
    return std::visit(
        [&](const auto &l) -> std::optional<Emission> {
            if constexpr (std::decay_t<decltype(l)>::traits.infinite)
                return std::nullopt;
            else
                return emit(l, inwards, u_position, to, u_choice);
        },
        light);
}

} // namespace glimmer
