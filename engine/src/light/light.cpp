// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/light.h"

#include "light/shapes/ellipse.h"
#include "light/shapes/rectangle.h"
#include "light/shapes/triangle.h"
#include "sampling/warp.h"

#include <cmath>

namespace glimmer {

namespace {

constexpr double kPiDouble = 3.14159265358979323846;

float falloff(const std::optional<SpotCone> &cone, const Vec3f &from_light) {
    return cone ? cone->falloff(from_light) : 1.0f;
}

RectangleShape seen_from(const AreaLamp &light, const Vec3d &x) {
    return {light.center - light.half_x - light.half_y - x, light.half_x * 2.0, light.half_y * 2.0};
}

/// Intensity of a surface, for bounds. Radiance times area may be beyond float32 though a picture of it is not; it only
/// guides choices, so it is capped there (infinite weights would make every share of them NaN).
float bounded_strength(const Rgb &radiance, double area) {
    return float(std::min(double(mean_component(radiance)) * area, 1e30));
}

/// Where a direction stands in an equirectangular picture: centre along +y, z up; u to the right, v down, both 0 to 1.
Vec2f equirectangular(const Vec3f &d) {
    const float u = 0.5f + std::atan2(d.x, d.y) / (2 * kPi);
    const float v = std::atan2(std::hypot(d.x, d.y), d.z) / kPi;
    return {u, v};
}

// One overload a light, for std::visit.

std::optional<LightSample> sample(const SphereLight &light, const Vec3f &x, Vec2f u) {
    return sample_light(light, x, u);
}

std::optional<LightSample> sample(const MeshLight &light, const Vec3f &x, Vec2f u) {
    const AliasSample choice = light.choice.sample(u.x, u.y);
    const MeshLight::Triangle &t = light.triangles[choice.index];
    const Vec3d at(x), a = t.vertices[0] - at, b = t.vertices[1] - at, c = t.vertices[2] - at;
    const auto s = sample_triangle(a, b, c, {choice.rest, u.y});
    if (!s)
        return std::nullopt;
    const Vec3d normal = cross(b - a, c - a);
    const auto cosine = float(std::abs(dot(normal, Vec3d(s->wi))) / length(normal));
    return LightSample{s->wi, s->distance, t.radiance, s->pdf * choice.pmf, false, kNone, t.error, cosine};
}

std::optional<LightSample> sample(const PointLamp &light, const Vec3f &x, Vec2f) {
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

std::optional<LightSample> sample(const SphereLamp &light, const Vec3f &x, Vec2f u) {
    const auto s = sample_sphere(light.sphere.center - Vec3d(x), light.sphere.radius, u);
    if (!s)
        return std::nullopt;
    const float factor = falloff(light.cone, -s->wi);
    if (factor == 0)
        return std::nullopt;
    return LightSample{s->wi, s->distance, light.radiance * factor, s->pdf, false};
}

std::optional<LightSample> sample(const AreaLamp &light, const Vec3f &x, Vec2f u) {
    const Vec3d at(x);
    if (dot(at - light.center, light.normal) <= 0)
        return std::nullopt;
    const auto s = light.ellipse ? sample_ellipse({light.center - at, light.half_x, light.half_y}, u)
                                 : sample_rectangle(seen_from(light, at), u);
    if (!s)
        return std::nullopt;
    return LightSample{s->wi, s->distance, light.radiance, s->pdf, false};
}

std::optional<LightSample> sample(const SunLamp &light, const Vec3f &, Vec2f u) {
    const DirectionSample s = sample_sun(light.disk, u);
    const bool delta = light.disk.is_delta();
    return LightSample{s.wi, s.distance, delta ? light.irradiance : light.radiance, s.pdf, delta};
}

std::optional<LightSample> sample(const EnvironmentLight &light, const Vec3f &, Vec2f u) {
    Vec3f local;
    float pdf;
    if (light.distribution.empty()) {
        local = sample_uniform_sphere(u);
        pdf = pdf_uniform_sphere();
    } else {
        const Distribution2dSample s = light.distribution.sample(u);
        const float phi = (s.uv.x - 0.5f) * 2 * kPi, theta = s.uv.y * kPi, sine = std::sin(theta);
        local = {sine * std::sin(phi), sine * std::cos(phi), std::cos(theta)};
        if (!(sine > 0))
            return std::nullopt;
        pdf = s.pdf / (2 * kPi * kPi * sine);
    }
    const Vec3f direction = light.to_local[0] * local.x + light.to_local[1] * local.y + light.to_local[2] * local.z;
    return LightSample{direction, kInfinity, light.radiance(direction), pdf, false};
}

} // namespace

Rgb EnvironmentLight::radiance(const Vec3f &direction) const {
    if (pixels.empty())
        return color;
    const Vec2f uv =
        equirectangular({dot(to_local[0], direction), dot(to_local[1], direction), dot(to_local[2], direction)});
    // Bilinear between texel centres; wraps around, and stops at the poles.
    const float px = uv.x * float(width) - 0.5f, py = std::clamp(uv.y * float(height) - 0.5f, 0.0f, float(height - 1));
    const float fx = px - std::floor(px), fy = py - std::floor(py);
    const auto column = [&](float x) { return size_t((int64_t(x) + int64_t(width)) % int64_t(width)); };
    const size_t x0 = column(std::floor(px)), x1 = column(std::floor(px) + 1);
    const auto y0 = size_t(py), y1 = std::min(y0 + 1, size_t(height - 1));
    const Rgb top = pixels[y0 * width + x0] * (1 - fx) + pixels[y0 * width + x1] * fx;
    const Rgb bottom = pixels[y1 * width + x0] * (1 - fx) + pixels[y1 * width + x1] * fx;
    return (top * (1 - fy) + bottom * fy) * color;
}

std::optional<LightSample> sample_light(const Light &light, const Vec3f &x, Vec2f u) {
    return std::visit([&](const auto &l) { return sample(l, x, u); }, light);
}

float light_pdf(const Light &light, const Vec3f &x, const Vec3f &direction, uint32_t triangle, float distance,
                float cosine) {
    const Vec3d at(x);
    if (const auto *l = std::get_if<SphereLight>(&light))
        return pdf_sphere(l->sphere.center - at, l->sphere.radius);
    if (const auto *l = std::get_if<SphereLamp>(&light))
        return pdf_sphere(l->sphere.center - at, l->sphere.radius);
    if (const auto *l = std::get_if<MeshLight>(&light)) {
        const MeshLight::Triangle &t = l->triangles[triangle];
        const double area = 0.5 * length(cross(t.vertices[1] - t.vertices[0], t.vertices[2] - t.vertices[0]));
        const double d = double(distance);
        return l->choice.pmf(triangle) * float(pdf_area_to_solid_angle(d * d, double(cosine), area));
    }
    if (const auto *l = std::get_if<AreaLamp>(&light))
        return l->ellipse ? pdf_ellipse({l->center - at, l->half_x, l->half_y}, direction)
                          : pdf_rectangle(seen_from(*l, at), direction);
    if (const auto *l = std::get_if<SunLamp>(&light))
        return pdf_sun(l->disk, direction);
    if (const auto *l = std::get_if<EnvironmentLight>(&light)) {
        if (l->distribution.empty())
            return pdf_uniform_sphere();
        const Vec3f local{dot(l->to_local[0], direction), dot(l->to_local[1], direction),
                          dot(l->to_local[2], direction)};
        const float sine = std::hypot(local.x, local.y);
        return sine > 0 ? l->distribution.pdf(equirectangular(local)) / (2 * kPi * kPi * sine) : 0.0f;
    }
    return 0;
}

std::optional<LampHit> intersect_lamp(const Light &light, const Ray &ray) {
    if (const auto *l = std::get_if<SphereLamp>(&light)) {
        const auto roots = intersect_sphere(l->sphere, Vec3d(ray.origin), Vec3d(ray.direction));
        if (!roots)
            return std::nullopt;
        const auto t = float(roots->near > 0 ? roots->near : roots->far);
        if (!(t > 0 && t < ray.t_max))
            return std::nullopt;
        const float factor = falloff(l->cone, -ray.direction);
        if (factor == 0)
            return std::nullopt;
        return LampHit{t, l->radiance * factor};
    }
    if (const auto *l = std::get_if<AreaLamp>(&light)) {
        const Vec3d direction(ray.direction), to_center = l->center - Vec3d(ray.origin);
        const double cosine = dot(direction, l->normal);
        if (cosine >= 0)
            return std::nullopt;
        const double t = dot(to_center, l->normal) / cosine;
        if (!(t > 0 && t < double(ray.t_max)))
            return std::nullopt;
        const Vec3d on = direction * t - to_center;
        const double x = dot(on, l->half_x) / length_squared(l->half_x),
                     y = dot(on, l->half_y) / length_squared(l->half_y);
        if (l->ellipse ? x * x + y * y > 1 : std::abs(x) > 1 || std::abs(y) > 1)
            return std::nullopt;
        return LampHit{float(t), l->radiance};
    }
    return std::nullopt;
}

Rgb radiance_from_infinity(const Light &light, const Vec3f &direction) {
    if (const auto *l = std::get_if<EnvironmentLight>(&light))
        return l->radiance(direction);
    if (const auto *l = std::get_if<SunLamp>(&light); l && pdf_sun(l->disk, direction) > 0)
        return l->radiance;
    return {};
}

LightBound bound_light(const Light &light) {
    LightBound b;
    if (const auto *l = std::get_if<SphereLight>(&light)) {
        const auto r = float(l->sphere.radius);
        b = {Vec3f(l->sphere.center), r, false,
             bounded_strength(l->radiance, kPiDouble * l->sphere.radius * l->sphere.radius)};
    } else if (const auto *l = std::get_if<MeshLight>(&light)) {
        b = {l->center, l->radius, false, mean_component(l->intensity)};
    } else if (const auto *l = std::get_if<PointLamp>(&light)) {
        b = {l->position, 0, false, mean_component(l->intensity)};
    } else if (const auto *l = std::get_if<SphereLamp>(&light)) {
        const auto r = float(l->sphere.radius);
        b = {Vec3f(l->sphere.center), r, false,
             bounded_strength(l->radiance, kPiDouble * l->sphere.radius * l->sphere.radius)};
    } else if (const auto *l = std::get_if<AreaLamp>(&light)) {
        const double x = length(l->half_x), y = length(l->half_y);
        const double area = l->ellipse ? kPiDouble * x * y : 4 * x * y;
        b = {Vec3f(l->center), float(l->ellipse ? std::max(x, y) : std::hypot(x, y)), false,
             bounded_strength(l->radiance, area)};
    } else if (const auto *l = std::get_if<SunLamp>(&light)) {
        b.infinite = true;
        b.strength = mean_component(l->irradiance);
    } else if (const auto *l = std::get_if<EnvironmentLight>(&light)) {
        b.infinite = true;
        b.strength = kPi * mean_component(l->mean);
    }
    return b;
}

} // namespace glimmer
