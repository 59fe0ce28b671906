// SPDX-License-Identifier: GPL-3.0-or-later
// Three-component vectors and colours as plain value types, and the orthonormal frame about a normal.
#pragma once

#include "math/constants.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace glimmer {

/// A direction or position. T is float in the path loop, double where scenes are read and spheres intersected.
template <class T>
struct Vec3 {
    T x{}, y{}, z{};

    constexpr Vec3() = default;
    constexpr Vec3(T x_, T y_, T z_) : x(x_), y(y_), z(z_) {}
    template <class U>
    explicit constexpr Vec3(const Vec3<U> &v) : x(T(v.x)), y(T(v.y)), z(T(v.z)) {}

    constexpr T operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
    constexpr Vec3 operator-() const { return {-x, -y, -z}; }
    constexpr Vec3 &operator+=(const Vec3 &b) { return *this = {x + b.x, y + b.y, z + b.z}; }
    friend constexpr Vec3 operator+(const Vec3 &a, const Vec3 &b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend constexpr Vec3 operator-(const Vec3 &a, const Vec3 &b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend constexpr Vec3 operator*(const Vec3 &a, T s) { return {a.x * s, a.y * s, a.z * s}; }
    friend constexpr Vec3 operator*(T s, const Vec3 &a) { return a * s; }
    friend constexpr Vec3 operator/(const Vec3 &a, T s) { return {a.x / s, a.y / s, a.z / s}; }
    friend constexpr bool operator==(const Vec3 &, const Vec3 &) = default;
};

using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;

struct Vec2f {
    float x{}, y{};
};

template <class T>
constexpr T dot(const Vec3<T> &a, const Vec3<T> &b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
constexpr Vec3<T> cross(const Vec3<T> &a, const Vec3<T> &b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
constexpr T length_squared(const Vec3<T> &a) {
    return dot(a, a);
}
template <class T>
T length(const Vec3<T> &a) {
    return std::sqrt(dot(a, a));
}
template <class T>
Vec3<T> normalize(const Vec3<T> &a) {
    return a / length(a);
}
template <class T>
constexpr T max_abs(const Vec3<T> &a) {
    const T x = a.x < 0 ? -a.x : a.x, y = a.y < 0 ? -a.y : a.y, z = a.z < 0 ? -a.z : a.z;
    return std::max(x, std::max(y, z));
}

/// Linear Rec. 709: radiance, reflectance, throughput or a coefficient per channel.
struct Rgb {
    float r{}, g{}, b{};

    constexpr Rgb() = default;
    explicit constexpr Rgb(float grey) : r(grey), g(grey), b(grey) {}
    constexpr Rgb(float r_, float g_, float b_) : r(r_), g(g_), b(b_) {}

    constexpr float operator[](int i) const { return i == 0 ? r : i == 1 ? g : b; }
    constexpr float &operator[](int i) { return i == 0 ? r : i == 1 ? g : b; }
    constexpr Rgb &operator+=(const Rgb &o) { return *this = {r + o.r, g + o.g, b + o.b}; }
    constexpr Rgb &operator*=(const Rgb &o) { return *this = {r * o.r, g * o.g, b * o.b}; }
    constexpr Rgb &operator*=(float s) { return *this = {r * s, g * s, b * s}; }
    friend constexpr Rgb operator+(const Rgb &a, const Rgb &o) { return {a.r + o.r, a.g + o.g, a.b + o.b}; }
    friend constexpr Rgb operator-(const Rgb &a, const Rgb &o) { return {a.r - o.r, a.g - o.g, a.b - o.b}; }
    friend constexpr Rgb operator*(const Rgb &a, const Rgb &o) { return {a.r * o.r, a.g * o.g, a.b * o.b}; }
    friend constexpr Rgb operator*(const Rgb &a, float s) { return {a.r * s, a.g * s, a.b * s}; }
    friend constexpr Rgb operator*(float s, const Rgb &a) { return a * s; }
    friend constexpr Rgb operator/(const Rgb &a, float s) { return {a.r / s, a.g / s, a.b / s}; }
    friend constexpr bool operator==(const Rgb &, const Rgb &) = default;
};

constexpr float max_component(const Rgb &c) {
    return std::max(c.r, std::max(c.g, c.b));
}
constexpr bool is_black(const Rgb &c) {
    return c.r == 0 && c.g == 0 && c.b == 0;
}
/// What choices go by. The error of a picture is judged channel by channel (relMSE): by luminance, blue light would get
/// a tenth of the samples of green.
constexpr float mean_component(const Rgb &c) {
    return (c.r + c.g + c.b) * (1 / 3.0f);
}
inline bool is_finite(const Rgb &c) {
    return std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b);
}

/// Orthonormal right-handed frame with z along a unit normal (Duff et al. 2017, JCGT 6(1), listing 3).
struct Frame {
    Vec3f x, y, z;

    explicit Frame(const Vec3f &n) : z(n) {
        const float sign = std::copysign(1.0f, n.z);
        const float a = -1.0f / (sign + n.z);
        const float b = n.x * n.y * a;
        x = {1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x};
        y = {b, sign + n.y * n.y * a, -n.y};
    }
    Vec3f to_local(const Vec3f &v) const { return {dot(v, x), dot(v, y), dot(v, z)}; }
    Vec3f to_world(const Vec3f &v) const { return x * v.x + y * v.y + z * v.z; }
};

} // namespace glimmer
