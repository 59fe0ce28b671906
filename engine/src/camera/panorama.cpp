// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/panorama.h"

#include "math/constants.h"

#include <cmath>

namespace glimmer {

namespace {

/// (sin t / t) and its like near 0 are asked for nowhere else.
float sine_over(float angle, float distance) {
    return distance > 0 ? std::sin(angle) / distance : 0;
}

float value(const std::array<float, 5> &c, float x) {
    return c[0] + x * (c[1] + x * (c[2] + x * (c[3] + x * c[4])));
}
float slope(const std::array<float, 5> &c, float x) {
    return c[1] + x * (2 * c[2] + x * (3 * c[3] + x * 4 * c[4]));
}

/// The polynomial is followed along so many points to see whether it turns back.
constexpr int kPolynomialSteps = 1000;
/// Directions nearer to the axis than this, in radians, may be seen twice: no picture shows it.
constexpr float kBlindSpot = 1e-4f;

} // namespace

float Panorama::angle_at(float distance) const {
    switch (type) {
    case PanoramaType::fisheye_equidistant:
        return distance * half_angle;
    case PanoramaType::fisheye_equisolid:
        return 2 * std::asin(std::min(distance / (2 * focal_length), 1.0f));
    default:
        return value(polynomial, distance);
    }
}

float Panorama::distance_at(float angle) const {
    switch (type) {
    case PanoramaType::fisheye_equidistant:
        return angle / half_angle;
    case PanoramaType::fisheye_equisolid:
        return 2 * focal_length * std::sin(angle / 2);
    default: {
        // By halves, then as Newton has it: a polynomial that turns back beyond `reach` must not lead astray.
        float low = 0, high = reach;
        const bool rising = value(polynomial, reach) > value(polynomial, 0);
        for (int i = 0; i < 24; ++i) {
            const float middle = 0.5f * (low + high);
            ((value(polynomial, middle) < angle) == rising ? low : high) = middle;
        }
        const float middle = 0.5f * (low + high), steepness = slope(polynomial, middle);
        return steepness != 0 ? middle + (angle - value(polynomial, middle)) / steepness : middle;
    }
    }
}

bool Panorama::is_beyond(float distance, float angle) const {
    switch (type) {
    case PanoramaType::fisheye_equidistant:
        return distance > 1;
    case PanoramaType::fisheye_equisolid:
        return distance > 2 * focal_length * std::sin(half_angle / 2);
    default:
        return std::abs(angle) > half_angle;
    }
}

float Panorama::angle_to_axis(const Vec3f &d) const {
    const float angle = std::atan2(std::sqrt(d.x * d.x + d.y * d.y), d.z);
    return type == PanoramaType::fisheye_polynomial && value(polynomial, reach) < 0 ? -angle : angle;
}

std::optional<Vec3f> Panorama::direction(Vec2f film) const {
    const Vec2f size = window_size();
    const float u = window.begin.x + film.x * size.x, v = 1 - (window.begin.y + film.y * size.y);
    switch (type) {
    case PanoramaType::equirectangular: {
        const float across = longitude[0] + u * (longitude[1] - longitude[0]);
        const float up = latitude[0] + v * (latitude[1] - latitude[0]), level = std::cos(up);
        return Vec3f(std::sin(across) * level, std::sin(up), std::cos(across) * level);
    }
    case PanoramaType::cylindrical: {
        const float across = longitude[0] + u * (longitude[1] - longitude[0]);
        return normalize(Vec3f(std::sin(across), latitude[0] + v * (latitude[1] - latitude[0]), std::cos(across)));
    }
    case PanoramaType::cube_face:
        return normalize(Vec3f(std::tan((u - 0.5f) * (kPi / 2)), std::tan((v - 0.5f) * (kPi / 2)), 1));
    case PanoramaType::mirror_ball: {
        const float x = 2 * u - 1, y = 2 * v - 1, square = x * x + y * y;
        if (square > 1)
            return std::nullopt;
        const float z = std::sqrt(1 - square);
        return Vec3f(2 * z * x, 2 * z * y, 1 - 2 * square);
    }
    default: {
        const bool equidistant = type == PanoramaType::fisheye_equidistant;
        const float x = (u - 0.5f) * (equidistant ? 2 : 1), y = (v - 0.5f) * (equidistant ? 2 : aspect);
        const float distance = std::sqrt(x * x + y * y), angle = angle_at(distance);
        if (is_beyond(distance, angle))
            return std::nullopt;
        const float sine = sine_over(angle, distance);
        return Vec3f(x * sine, y * sine, std::cos(angle));
    }
    }
}

Vec2f Panorama::place(const Vec3f &d) const {
    const float off_axis = std::sqrt(d.x * d.x + d.y * d.y);
    switch (type) {
    case PanoramaType::equirectangular:
    case PanoramaType::cylindrical: {
        const float level = std::sqrt(d.x * d.x + d.z * d.z);
        const float up = type == PanoramaType::cylindrical ? d.y / level : std::atan2(d.y, level);
        const float span = longitude[1] - longitude[0], middle = longitude[0] + span / 2;
        // The turn that is nearest to the middle.
        const float across = std::remainder(std::atan2(d.x, d.z) - middle, 2 * kPi) + middle;
        return {(across - longitude[0]) / span, (up - latitude[0]) / (latitude[1] - latitude[0])};
    }
    case PanoramaType::cube_face:
        return {0.5f + std::atan2(d.x, d.z) * (2 / kPi), 0.5f + std::atan2(d.y, d.z) * (2 / kPi)};
    case PanoramaType::mirror_ball: {
        const float sum = d.z > 0 ? 1 + d.z : off_axis * off_axis / (1 - d.z); // 1 + d.z, with all its digits
        const float length = 2 * std::sqrt(0.5f * sum);
        return length > 0 ? Vec2f{0.5f + 0.5f * d.x / length, 0.5f + 0.5f * d.y / length} : Vec2f{0.5f, 0.5f};
    }
    default: {
        const float angle = angle_to_axis(d), distance = distance_at(angle);
        const float factor = off_axis > 0 ? (angle < 0 ? -distance : distance) / off_axis : 0;
        const bool equidistant = type == PanoramaType::fisheye_equidistant;
        return {0.5f + d.x * factor / (equidistant ? 2 : 1), 0.5f + d.y * factor / (equidistant ? 2 : aspect)};
    }
    }
}

std::optional<Vec2f> Panorama::film(const Vec3f &d) const {
    if (type == PanoramaType::cube_face && !(d.z > 0))
        return std::nullopt;
    if (is_fisheye()) {
        const float angle = angle_to_axis(d), distance = distance_at(angle);
        if (is_beyond(distance, angle) ||
            (type == PanoramaType::fisheye_polynomial && !(distance >= 0 && distance <= reach)))
            return std::nullopt;
    }
    return to_film(place(d));
}

float Panorama::solid_angle(const Vec3f &d) const {
    const Vec2f size = window_size();
    const float shown = size.x * size.y;
    const float spans = std::abs((longitude[1] - longitude[0]) * (latitude[1] - latitude[0]));
    switch (type) {
    case PanoramaType::equirectangular:
        return shown * spans * std::sqrt(d.x * d.x + d.z * d.z);
    case PanoramaType::cylindrical: {
        const float level = std::sqrt(d.x * d.x + d.z * d.z);
        return shown * spans * level * level * level;
    }
    case PanoramaType::cube_face: {
        const float x = d.x / d.z, y = d.y / d.z;
        return shown * (kPi * kPi / 4) * (1 + x * x) * (1 + y * y) * (d.z * d.z * d.z);
    }
    case PanoramaType::mirror_ball:
        return shown * 16;
    case PanoramaType::fisheye_equisolid:
        return shown * aspect / (focal_length * focal_length);
    default: {
        const bool equidistant = type == PanoramaType::fisheye_equidistant;
        const float angle = angle_to_axis(d), distance = distance_at(angle);
        const float steepness = equidistant ? half_angle : slope(polynomial, distance);
        const float ratio = distance > 0 ? std::sin(angle) / distance : steepness;
        return shown * (equidistant ? 4 : aspect) * std::abs(ratio * steepness);
    }
    }
}

float Panorama::farthest(Vec2f margin) const {
    const Vec2f size = window_size();
    const float x = std::max(std::abs(window.begin.x - margin.x * size.x - 0.5f),
                             std::abs(window.end.x + margin.x * size.x - 0.5f)),
                y = std::max(std::abs(window.begin.y - margin.y * size.y - 0.5f),
                             std::abs(window.end.y + margin.y * size.y - 0.5f));
    return std::sqrt(x * x + y * y * aspect * aspect);
}

bool Panorama::is_invertible(Vec2f margin) const {
    switch (type) {
    case PanoramaType::equirectangular:
    case PanoramaType::cylindrical: {
        const Vec2f size = window_size();
        const float span = std::abs(longitude[1] - longitude[0]) * (1 + 1e-5f);
        const bool near =
            std::abs(window.begin.x + window.end.x - 1) < 2 && std::abs(window.begin.y + window.end.y - 1) < 2;
        // A window of more than one turn, or far from the panorama, has more places than are looked for.
        return near && span * size.x * (1 + 2 * margin.x) < 3 * 2 * kPi && size.y * (1 + 2 * margin.y) < 2;
    }
    case PanoramaType::cube_face: // beyond a right angle from the axis tangents come back
        return farthest(margin) < 1;
    case PanoramaType::fisheye_equidistant:
        return half_angle <= kPi;
    case PanoramaType::fisheye_polynomial: {
        const float last = value(polynomial, reach), sign = last < 0 ? -1.0f : 1.0f;
        if (std::abs(value(polynomial, 0)) > kBlindSpot && sign * value(polynomial, 0) < 0)
            return false;
        for (int i = 0; i <= kPolynomialSteps; ++i) {
            const float at = reach * float(i) / kPolynomialSteps;
            if (!(sign * slope(polynomial, at) > 0) || !(std::abs(value(polynomial, at)) <= kPi))
                return false;
        }
        return true;
    }
    default:
        return true;
    }
}

float Panorama::angle_per_width(float film_aspect) const {
    constexpr int kPoints = 16;
    constexpr float kStep = 1.0f / 256;
    float widest = 0;
    for (int i = 0; i <= kPoints; ++i)
        for (int k = 0; k <= kPoints; ++k) {
            const Vec2f at{float(i) / kPoints, float(k) / kPoints};
            const auto here = direction(at), right = direction({at.x + kStep, at.y}),
                       below = direction({at.x, at.y + kStep / film_aspect});
            for (const auto &there : {right, below})
                if (here && there)
                    widest = std::max(widest, length(*there - *here) / kStep);
        }
    return widest;
}

} // namespace glimmer
