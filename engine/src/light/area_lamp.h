// SPDX-License-Identifier: GPL-3.0-or-later
// A see-through rectangle or ellipse that shines to one side.
#pragma once

#include "light/emission.h"
#include "light/interface.h"
#include "light/shapes/ellipse.h"
#include "light/shapes/rectangle.h"
#include "light/shapes/sphere.h"

#include <algorithm>
#include <cmath>

namespace glimmer {

struct AreaLamp {
    Vec3d center, half_x, half_y, normal; ///< shines along the normal
    bool ellipse;
    Rgb radiance;                            ///< along the normal, but for the spread
    double tan_spread = 0, spread_scale = 0; ///< see spread(); 0: it shines to all sides

    /// Makes it shine no farther from its normal than half of a full angle in degrees, above 0 and below 180: as if
    /// slats stood before it, with the power that it would have without.
    void set_spread(double angle_degrees) {
        const double half = angle_degrees * kPiDouble / 360;
        tan_spread = std::tan(half);
        // The integral of cos (1 - tan / tan_spread) sin over the angle to the normal is half of 1 / spread_scale.
        spread_scale = half < 0.01 ? 3 / (half * half) : 1 / (1 - half / tan_spread);
    }
    /// Factor of the radiance at the cosine of the angle to the normal.
    float spread(double cosine) const {
        if (tan_spread == 0)
            return 1;
        const double tangent = std::sqrt(std::max(1 - cosine * cosine, 0.0)) / cosine;
        return float(std::max((1 - tangent / tan_spread) * spread_scale, 0.0));
    }

    static constexpr LightTraits traits{.intersectable = true};

    RectangleShape rectangle_from(const Vec3d &x) const {
        return {center - half_x - half_y - x, half_x * 2.0, half_y * 2.0};
    }
    EllipseShape ellipse_from(const Vec3d &x) const { return {center - x, half_x, half_y}; }
};

inline std::optional<LightSample> sample(const AreaLamp &light, const Vec3f &x, Vec2f u) {
    const Vec3d at(x);
    if (dot(at - light.center, light.normal) <= 0)
        return std::nullopt;
    const auto s =
        light.ellipse ? sample_ellipse(light.ellipse_from(at), u) : sample_rectangle(light.rectangle_from(at), u);
    if (!s)
        return std::nullopt;
    const Rgb radiance = light.radiance * light.spread(-dot(Vec3d(s->wi), light.normal));
    return LightSample{s->wi, s->distance, radiance, s->pdf, false};
}

inline float pdf(const AreaLamp &light, const Vec3f &x, const Vec3f &direction, const LightHit &) {
    const Vec3d at(x);
    return light.ellipse ? pdf_ellipse(light.ellipse_from(at), direction)
                         : pdf_rectangle(light.rectangle_from(at), direction);
}

inline std::optional<LampHit> intersect(const AreaLamp &light, const Ray &ray) {
    const Vec3d direction(ray.direction), to_center = light.center - Vec3d(ray.origin);
    const double cosine = dot(direction, light.normal);
    if (cosine >= 0)
        return std::nullopt;
    const double t = dot(to_center, light.normal) / cosine;
    if (!(t > 0 && t < double(ray.t_max)))
        return std::nullopt;
    const Vec3d on = direction * t - to_center;
    const double x = dot(on, light.half_x) / length_squared(light.half_x),
                 y = dot(on, light.half_y) / length_squared(light.half_y);
    if (light.ellipse ? x * x + y * y > 1 : std::abs(x) > 1 || std::abs(y) > 1)
        return std::nullopt;
    return LampHit{float(t), light.radiance * light.spread(-cosine)};
}

inline Emission emit(const AreaLamp &light, bool, Vec2f u_position, const EmissionDirection &to, float) {
    double x = 2 * double(u_position.x) - 1, y = 2 * double(u_position.y) - 1;
    double area = 4 * length(light.half_x) * length(light.half_y);
    if (light.ellipse) {
        const Vec2f d = sample_uniform_disk(u_position);
        x = double(d.x), y = double(d.y);
        area *= kPiDouble / 4;
    }
    const Vec3f position(light.center + light.half_x * x + light.half_y * y);
    if (light.tan_spread == 0 || to.is_given())
        return emit_from_surface(position, Vec3f(light.normal), 0, area, to, [&](const Vec3f &direction) {
            return light.radiance * light.spread(dot(Vec3d(direction), light.normal));
        });
    // Cosine-distributed within the spread.
    const double sine2 = light.tan_spread * light.tan_spread / (1 + light.tan_spread * light.tan_spread);
    const double sine = std::sqrt(double(to.u.x) * sine2), phi = 2 * kPiDouble * double(to.u.y);
    const double cosine = std::sqrt(1 - sine * sine);
    const Vec3d direction = about_axis(light.normal, sine * std::cos(phi), sine * std::sin(phi), cosine);
    return {{position, Vec3f(direction), {}},
            light.radiance * (light.spread(cosine) * float(kPiDouble * area * sine2))};
}

inline LightBound bound(const AreaLamp &light) {
    const double x = length(light.half_x), y = length(light.half_y);
    const double area = light.ellipse ? kPiDouble * x * y : 4 * x * y;
    return {Vec3f(light.center), float(light.ellipse ? std::max(x, y) : std::hypot(x, y)), false,
            bounded_strength(light.radiance, area)};
}

} // namespace glimmer
