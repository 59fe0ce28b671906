// SPDX-License-Identifier: GPL-3.0-or-later
// Arithmetic of numbers and vectors as Blender's Math, Vector Math, Map Range and Clamp nodes define it: what has no
// value (a division by 0, the root of a negative number) is 0.
#pragma once

#include "math/vec.h"

#include <limits>

namespace glimmer::nodes {

/// In the order of the op table (shading/ops.h).
enum class MathKind : uint8_t {
    add,
    subtract,
    multiply,
    divide,
    multiply_add,
    power,
    logarithm,
    sqrt,
    inverse_sqrt,
    absolute,
    exponent,
    minimum,
    maximum,
    less_than,
    greater_than,
    sign,
    compare,
    smooth_min,
    smooth_max,
    round,
    floor,
    ceil,
    trunc,
    fraction,
    modulo,
    floored_modulo,
    wrap,
    snap,
    pingpong,
    sine,
    cosine,
    tangent,
    arcsine,
    arccosine,
    arctangent,
    arctan2,
    sinh,
    cosh,
    tanh,
    radians,
    degrees
};

inline float safe_divide(float a, float b) {
    return b != 0 ? a / b : 0.0f;
}

/// A negative base has powers of whole exponents alone.
inline float safe_power(float a, float b) {
    if (a < 0 && b != std::trunc(b))
        return 0;
    const float p = std::pow(a, b);
    return std::isfinite(p) ? p : 0.0f;
}

inline float safe_modulo(float a, float b) {
    return b != 0 ? std::fmod(a, b) : 0.0f;
}

inline float wrap(float x, float most, float least) {
    const float range = most - least;
    return range != 0 ? x - range * std::floor((x - least) / range) : least;
}

inline float smooth_min(float a, float b, float distance) {
    if (distance == 0)
        return std::min(a, b);
    const float h = std::max(distance - std::abs(a - b), 0.0f) / distance;
    return std::min(a, b) - h * h * h * distance * (1.0f / 6.0f);
}

inline float math(MathKind kind, float a, float b, float c) {
    switch (kind) {
    case MathKind::add:
        return a + b;
    case MathKind::subtract:
        return a - b;
    case MathKind::multiply:
        return a * b;
    case MathKind::divide:
        return safe_divide(a, b);
    case MathKind::multiply_add:
        return a * b + c;
    case MathKind::power:
        return safe_power(a, b);
    case MathKind::logarithm:
        return a > 0 && b > 0 ? safe_divide(std::log(a), std::log(b)) : 0.0f;
    case MathKind::sqrt:
        return std::sqrt(std::max(a, 0.0f));
    case MathKind::inverse_sqrt:
        return a > 0 ? 1 / std::sqrt(a) : 0.0f;
    case MathKind::absolute:
        return std::abs(a);
    case MathKind::exponent:
        return std::exp(a);
    case MathKind::minimum:
        return std::min(a, b);
    case MathKind::maximum:
        return std::max(a, b);
    case MathKind::less_than:
        return a < b ? 1.0f : 0.0f;
    case MathKind::greater_than:
        return a > b ? 1.0f : 0.0f;
    case MathKind::sign:
        return a > 0 ? 1.0f : a < 0 ? -1.0f : 0.0f;
    case MathKind::compare:
        return a == b || std::abs(a - b) <= std::max(c, std::numeric_limits<float>::epsilon()) ? 1.0f : 0.0f;
    case MathKind::smooth_min:
        return smooth_min(a, b, c);
    case MathKind::smooth_max:
        return -smooth_min(-a, -b, c);
    case MathKind::round:
        return std::floor(a + 0.5f);
    case MathKind::floor:
        return std::floor(a);
    case MathKind::ceil:
        return std::ceil(a);
    case MathKind::trunc:
        return std::trunc(a);
    case MathKind::fraction:
        return a - std::floor(a);
    case MathKind::modulo:
        return safe_modulo(a, b);
    case MathKind::floored_modulo:
        return b != 0 ? a - std::floor(a / b) * b : 0.0f;
    case MathKind::wrap:
        return wrap(a, b, c);
    case MathKind::snap:
        return std::floor(safe_divide(a, b)) * b;
    case MathKind::pingpong: {
        const float part = b != 0 ? (a - b) / (b * 2) : 0;
        return b != 0 ? std::abs((part - std::floor(part)) * b * 2 - b) : 0.0f;
    }
    case MathKind::sine:
        return std::sin(a);
    case MathKind::cosine:
        return std::cos(a);
    case MathKind::tangent:
        return std::tan(a);
    case MathKind::arcsine:
        return std::asin(std::clamp(a, -1.0f, 1.0f));
    case MathKind::arccosine:
        return std::acos(std::clamp(a, -1.0f, 1.0f));
    case MathKind::arctangent:
        return std::atan(a);
    case MathKind::arctan2:
        return std::atan2(a, b);
    case MathKind::sinh:
        return std::sinh(a);
    case MathKind::cosh:
        return std::cosh(a);
    case MathKind::tanh:
        return std::tanh(a);
    case MathKind::radians:
        return a * (kPi / 180);
    case MathKind::degrees:
        return a * (180 / kPi);
    }
    return 0;
}

enum class MapRangeKind : uint8_t { linear, stepped, smoothstep, smootherstep };

struct Range {
    float from_min, from_max, to_min, to_max, steps;
};

inline float map_range(MapRangeKind kind, float value, const Range &r, bool clamp) {
    const float t = safe_divide(value - r.from_min, r.from_max - r.from_min);
    const float unit = std::clamp(t, 0.0f, 1.0f);
    float factor = t;
    switch (kind) {
    case MapRangeKind::linear:
        break;
    case MapRangeKind::stepped:
        factor = r.steps > 0 ? std::floor(t * (r.steps + 1)) / r.steps : 0.0f;
        break;
    case MapRangeKind::smoothstep:
        factor = unit * unit * (3 - 2 * unit);
        break;
    case MapRangeKind::smootherstep:
        factor = unit * unit * unit * (unit * (unit * 6 - 15) + 10);
        break;
    }
    const float out = r.to_min + factor * (r.to_max - r.to_min);
    return clamp ? std::clamp(out, std::min(r.to_min, r.to_max), std::max(r.to_min, r.to_max)) : out;
}

} // namespace glimmer::nodes
