// SPDX-License-Identifier: GPL-3.0-or-later
// Cellular noise (Worley 1996) in one to four dimensions: one feature point a cell, as Blender's Voronoi node has them.
// The distance to an edge is that of Quilez's article on voronoi lines.
#pragma once

#include "shading/nodes/noise.h"

#include <limits>

namespace glimmer::nodes {

enum class VoronoiFeature : uint8_t { f1, f2, smooth_f1, distance_to_edge, sphere_radius };
enum class VoronoiMetric : uint8_t { euclidean, manhattan, chebychev, minkowski };

struct VoronoiParameters {
    float scale = 5, detail = 0, roughness = 0.5f, lacunarity = 2, smoothness = 1, exponent = 0.5f, randomness = 1;
    VoronoiFeature feature = VoronoiFeature::f1;
    VoronoiMetric metric = VoronoiMetric::euclidean;
    bool normalized = false;
    bool pcg = true; ///< else the cells' points are lookup3's of the cells' floats, as before Blender 4.2
};

struct VoronoiResult {
    float distance = 0;
    Vec3f color, position;
    float w = 0;
};

/// The search over neighbouring cells for one pattern of points.
template <size_t N>
class VoronoiCells {
  public:
    VoronoiCells(const VoronoiParameters &v, const Point<N> &p) : v_(v) {
        for (size_t i = 0; i < N; ++i) {
            const Cell c(p[i]);
            cell_[i] = c.index;
            rest_[i] = c.rest;
        }
    }

    struct Found {
        float distance = std::numeric_limits<float>::max();
        std::array<int32_t, N> offset{};
        Point<N> point{}; ///< from the cell of the place that is asked for
    };

    VoronoiResult nearest(bool second) const {
        Found first, next;
        each<1>([&](const std::array<int32_t, N> &offset) {
            const Point<N> point = feature_point(offset);
            const float d = distance(point, rest_);
            if (d < first.distance) {
                next = first;
                first = {d, offset, point};
            } else if (d < next.distance) {
                next = {d, offset, point};
            }
        });
        const Found &found = second ? next : first;
        return result(found.distance, color(found.offset), found.point);
    }

    VoronoiResult smooth(float smoothness) const {
        float total = 0;
        Vec3f mixed;
        Point<N> place{};
        bool begun = false;
        each<2>([&](const std::array<int32_t, N> &offset) {
            const Point<N> point = feature_point(offset);
            const float d = distance(point, rest_);
            float h = 1;
            if (begun) {
                const float t = std::clamp(0.5f + 0.5f * (total - d) / smoothness, 0.0f, 1.0f);
                h = t * t * (3 - 2 * t);
            }
            begun = true;
            float correction = smoothness * h * (1 - h);
            total = total + h * (d - total) - correction;
            correction /= 1 + 3 * smoothness;
            mixed = mixed * (1 - h) + color(offset) * h - Vec3f(correction, correction, correction);
            for (size_t i = 0; i < N; ++i)
                place[i] = place[i] * (1 - h) + point[i] * h - correction;
        });
        return result(total, mixed, place);
    }

    float distance_to_edge() const {
        if constexpr (N == 1) {
            const float middle = feature_point({0})[0];
            const float left = feature_point({-1})[0], right = feature_point({1})[0];
            return std::min(std::abs((middle + left) / 2 - rest_[0]), std::abs((middle + right) / 2 - rest_[0]));
        } else {
            Point<N> closest{};
            float best = std::numeric_limits<float>::max();
            each<1>([&](const std::array<int32_t, N> &offset) {
                const Point<N> way = feature_point(offset) + rest_ * -1.0f;
                if (const float d = squared(way); d < best) {
                    best = d;
                    closest = way;
                }
            });
            best = std::numeric_limits<float>::max();
            each<1>([&](const std::array<int32_t, N> &offset) {
                const Point<N> way = feature_point(offset) + rest_ * -1.0f;
                const Point<N> across = way + closest * -1.0f;
                const float size = squared(across);
                if (!(size > 0.0001f))
                    return;
                float d = 0;
                for (size_t i = 0; i < N; ++i)
                    d += (closest[i] + way[i]) / 2 * (across[i] / std::sqrt(size));
                best = std::min(best, d);
            });
            return best;
        }
    }

    float sphere_radius() const {
        Found home;
        each<1>([&](const std::array<int32_t, N> &offset) {
            const Point<N> point = feature_point(offset);
            if (const float d = squared(point + rest_ * -1.0f); d < home.distance)
                home = {d, offset, point};
        });
        float best = std::numeric_limits<float>::max();
        each<1>([&](std::array<int32_t, N> offset) {
            if (offset == std::array<int32_t, N>{})
                return;
            for (size_t i = 0; i < N; ++i)
                offset[i] += home.offset[i];
            best = std::min(best, squared(feature_point(offset) + home.point * -1.0f));
        });
        return std::sqrt(best) / 2;
    }

    float distance(const Point<N> &a, const Point<N> &b) const {
        if constexpr (N == 1)
            return std::abs(a[0] - b[0]);
        float sum = 0, most = 0;
        for (size_t i = 0; i < N; ++i) {
            const float d = std::abs(a[i] - b[i]);
            most = std::max(most, d);
            sum += v_.metric == VoronoiMetric::euclidean   ? d * d
                   : v_.metric == VoronoiMetric::minkowski ? std::pow(d, v_.exponent)
                                                           : d;
        }
        switch (v_.metric) {
        case VoronoiMetric::euclidean:
            return std::sqrt(sum);
        case VoronoiMetric::chebychev:
            return most;
        case VoronoiMetric::minkowski:
            return std::pow(sum, 1 / v_.exponent);
        case VoronoiMetric::manhattan:
            break;
        }
        return sum;
    }

  private:
    /// Calls visit for all offsets of up to R cells on each axis, the first axis running fastest.
    template <int R, class Visit>
    static void each(const Visit &visit) {
        constexpr int kSide = 2 * R + 1;
        int count = 1;
        for (size_t i = 0; i < N; ++i)
            count *= kSide;
        for (int k = 0; k < count; ++k) {
            std::array<int32_t, N> offset{};
            for (int rest = k, i = 0; i < int(N); ++i, rest /= kSide)
                offset[size_t(i)] = rest % kSide - R;
            visit(offset);
        }
    }

    static float squared(const Point<N> &p) {
        float sum = 0;
        for (float x : p)
            sum += x * x;
        return sum;
    }

    std::array<int32_t, N> at(const std::array<int32_t, N> &offset) const {
        std::array<int32_t, N> out{};
        for (size_t i = 0; i < N; ++i)
            out[i] = int32_t(uint32_t(cell_[i]) + uint32_t(offset[i]));
        return out;
    }
    Point<N> floats(const std::array<int32_t, N> &offset) const {
        Point<N> out{};
        for (size_t i = 0; i < N; ++i)
            out[i] = float(cell_[i]) + float(offset[i]);
        return out;
    }

    Point<N> feature_point(const std::array<int32_t, N> &offset) const {
        Point<N> jitter{};
        if constexpr (N == 1)
            jitter = hash_jitter(floats(offset));
        else
            jitter = v_.pcg ? pcg_point(at(offset)) : hash_jitter(floats(offset));
        for (size_t i = 0; i < N; ++i)
            jitter[i] = float(offset[i]) + jitter[i] * v_.randomness;
        return jitter;
    }

    Vec3f color(const std::array<int32_t, N> &offset) const {
        if constexpr (N == 1) {
            return hash_color(floats(offset));
        } else {
            if (!v_.pcg)
                return hash_color(floats(offset));
            const std::array<int32_t, N> cell = at(offset);
            if constexpr (N == 4) {
                const Point<4> c = pcg_point(cell);
                return {c[0], c[1], c[2]};
            } else {
                const Point<3> c = pcg_point(std::array<int32_t, 3>{cell[0], cell[1], N > 2 ? cell[N - 1] : 0});
                return {c[0], c[1], c[2]};
            }
        }
    }

    VoronoiResult result(float d, const Vec3f &c, const Point<N> &point) const {
        VoronoiResult out{d, c, {}, 0};
        const auto along = [&](size_t i) { return float(cell_[i]) + point[i]; };
        if constexpr (N == 1) {
            out.w = along(0);
        } else {
            out.position = {along(0), along(1), N > 2 ? along(N > 2 ? 2 : 0) : 0.0f};
            if constexpr (N == 4)
                out.w = along(3);
        }
        return out;
    }

    const VoronoiParameters &v_;
    std::array<int32_t, N> cell_{};
    Point<N> rest_{};
};

/// The largest distance that can occur, which normalising divides by.
template <size_t N>
float voronoi_reach(const VoronoiParameters &v) {
    Point<N> corner{};
    corner.fill(0.5f + 0.5f * v.randomness);
    if (v.feature == VoronoiFeature::distance_to_edge)
        return corner[0];
    return VoronoiCells<N>(v, {}).distance({}, corner) * (v.feature == VoronoiFeature::f2 ? 2.0f : 1.0f);
}

/// The range that Blender's node clamps its inputs to.
inline VoronoiParameters clamped(VoronoiParameters v) {
    v.detail = std::clamp(v.detail, 0.0f, kMostOctaves);
    v.roughness = std::clamp(v.roughness, 0.0f, 1.0f);
    v.randomness = std::clamp(v.randomness, 0.0f, 1.0f);
    v.smoothness = std::clamp(v.smoothness / 2, 0.0f, 0.5f);
    return v;
}

/// Distance, colour and place; octaves as in fBM, blended in where the detail is no whole number. p: already scaled.
template <size_t N>
VoronoiResult voronoi(const VoronoiParameters &inputs, const Point<N> &p) {
    const VoronoiParameters v = clamped(inputs);
    const auto one = [&](float frequency) {
        const VoronoiCells<N> cells(v, p * frequency);
        if (v.feature == VoronoiFeature::smooth_f1 && v.smoothness != 0)
            return cells.smooth(v.smoothness);
        return cells.nearest(v.feature == VoronoiFeature::f2);
    };
    VoronoiResult out;
    float amplitude = 1, most = 0, frequency = 1;
    if (v.detail == 0 || v.roughness == 0) {
        out = one(1);
        most = 1;
    } else {
        const float part = v.detail - std::floor(v.detail);
        for (int i = 0; float(i) <= std::ceil(v.detail); ++i) {
            const VoronoiResult octave = one(frequency);
            const float t = float(i) <= v.detail ? 1 : part;
            most += t * amplitude;
            out.distance += t * octave.distance * amplitude;
            out.color += octave.color * (t * amplitude);
            const float blend = t * amplitude;
            out.position = out.position + (octave.position / frequency - out.position) * blend;
            out.w += (octave.w / frequency - out.w) * blend;
            frequency *= v.lacunarity;
            amplitude *= v.roughness;
        }
    }
    if (v.normalized) {
        out.distance /= most * voronoi_reach<N>(v);
        out.color = out.color / most;
    }
    const float inverse = v.scale == 0 ? 0 : 1 / v.scale;
    out.position = out.position * inverse;
    out.w *= inverse;
    return out;
}

template <size_t N>
float voronoi_distance_to_edge(const VoronoiParameters &inputs, const Point<N> &p) {
    const VoronoiParameters v = clamped(inputs);
    const float reach = voronoi_reach<N>(v);
    float amplitude = 1, most = reach, frequency = 1, distance = 8;
    if (v.detail == 0 || v.roughness == 0) {
        distance = VoronoiCells<N>(v, p).distance_to_edge();
    } else {
        const float part = v.detail - std::floor(v.detail);
        for (int i = 0; float(i) <= std::ceil(v.detail); ++i) {
            const float octave = VoronoiCells<N>(v, p * frequency).distance_to_edge();
            const float blended = distance + (std::min(distance, octave / frequency) - distance) * amplitude;
            const float bound = most + (reach / frequency - most) * amplitude;
            if (float(i) <= v.detail) {
                distance = blended;
                most = bound;
            } else {
                distance += (std::min(distance, blended) - distance) * part;
                most += (bound - most) * part;
            }
            frequency *= v.lacunarity;
            amplitude *= v.roughness;
        }
    }
    return v.normalized ? distance / most : distance;
}

template <size_t N>
float voronoi_sphere_radius(const VoronoiParameters &inputs, const Point<N> &p) {
    const VoronoiParameters v = clamped(inputs);
    return VoronoiCells<N>(v, p).sphere_radius();
}

} // namespace glimmer::nodes
