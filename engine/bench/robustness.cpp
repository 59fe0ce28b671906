// SPDX-License-Identifier: GPL-3.0-or-later
// What the forms that hold in float32 cost: each beside the textbook's, of which the engine's comments say where it
// breaks. ns a call, robust and naive, on a busy machine with AVX-512: sphere light 24.9 and 14.4, sphere hit 3.9 and
// 1.7, offset 3.4 and 1.1, GGX D 0.96 and 0.71, 1 - e^-x 3.3 and 1.5, truncated exponential 8.2 and 3.8, equiangular 47
// and 27. A whole render, with all of these put back, takes 0.98 to 0.99 of the CPU time.
#include "inputs.h"
#include "light/shapes/sphere.h"
#include "medium/equiangular.h"
#include "sampling/exponential.h"
#include "scene/scene.h"

#include <benchmark/benchmark.h>
#include <cmath>

namespace glimmer {
namespace {

// ---- the textbook's forms ----

/// In float32, 1 - cos from the cosine; black from R/d = 1e-4 on.
std::optional<DirectionSample> naive_sample_sphere(const Vec3f &to_center, float radius, Vec2f u) {
    const float d2 = length_squared(to_center), d = std::sqrt(d2), sine = radius / d;
    const float cos_max = std::sqrt(std::max(0.0f, 1 - sine * sine)), cosine = 1 - u.x * (1 - cos_max);
    const Vec2f p = circle_point(std::sqrt(std::max(0.0f, 1 - cosine * cosine)), u.y);
    const Vec3f wi = Frame(to_center / d).to_world({p.x, p.y, cosine});
    const float root = std::sqrt(std::max(0.0f, radius * radius - d2 * (1 - cosine * cosine)));
    return DirectionSample{wi, d * cosine - root, 1 / (2 * kPi * (1 - cos_max))};
}

/// b^2 - 4 a c in float32.
std::optional<Vec2f> naive_intersect_sphere(const Vec3f &center, float radius, const Vec3f &origin, const Vec3f &w) {
    const Vec3f f = origin - center;
    const float a = dot(w, w), b = 2 * dot(f, w), c = dot(f, f) - radius * radius, discriminant = b * b - 4 * a * c;
    if (discriminant < 0)
        return std::nullopt;
    const float root = std::sqrt(discriminant);
    return Vec2f{(-b - root) / (2 * a), (-b + root) / (2 * a)};
}

float naive_ggx_d(const Vec3f &h, float alpha) {
    const float a2 = alpha * alpha, q = h.z * h.z * (a2 - 1) + 1;
    return a2 / (kPi * q * q);
}

float naive_truncated_exponential(float u, float tau) {
    return -std::log(1 - u * (1 - std::exp(-tau)));
}

struct NaiveEquiangular {
    float from, to, h;
    NaiveEquiangular(float a, float b, float h_) : from(std::atan(a / h_)), to(std::atan(b / h_)), h(h_) {}
    float sample(float u) const { return h * std::tan(from + u * (to - from)); }
};

// ---- pairs ----

const auto kDirections = upper_directions(1), kPlaces = upper_directions(2);
const auto kBits = [] {
    std::array<uint64_t, kInputs> bits;
    for (size_t i = 0; i < kInputs; ++i)
        bits[i] = hash64(3, i);
    return bits;
}();
const auto kNumbers = [] {
    std::array<float, 2 * kInputs> numbers;
    for (size_t i = 0; i < 2 * kInputs; ++i)
        numbers[i] = uniform(4, i);
    return numbers;
}();

void sphere_light_robust(benchmark::State &state) {
    run(state, [](size_t i) { return sample_sphere(Vec3d(kPlaces[i] * 30), 2, {kNumbers[i], kNumbers[i + kInputs]}); });
}
void sphere_light_naive(benchmark::State &state) {
    run(state, [](size_t i) { return naive_sample_sphere(kPlaces[i] * 30, 2, {kNumbers[i], kNumbers[i + kInputs]}); });
}
BENCHMARK(sphere_light_robust);
BENCHMARK(sphere_light_naive);

void sphere_hit_robust(benchmark::State &state) {
    const Sphere sphere{{0, 0, 30}, 20};
    run(state, [&](size_t i) { return intersect_sphere(sphere, Vec3d(kPlaces[i]), Vec3d(kDirections[i])); });
}
void sphere_hit_naive(benchmark::State &state) {
    run(state, [](size_t i) { return naive_intersect_sphere({0, 0, 30}, 20, kPlaces[i], kDirections[i]); });
}
BENCHMARK(sphere_hit_robust);
BENCHMARK(sphere_hit_naive);

/// The bound on the rounding of the hit, and the point moved by it.
void offset_robust(benchmark::State &state) {
    run(state, [](size_t i) {
        Interaction at;
        at.position = kPlaces[i] * 30;
        at.geometric_normal = kDirections[i];
        at.error = 0x1p-21f * (max_abs(at.position) + max_abs(kPlaces[i]) + max_abs(kDirections[i]));
        return at.origin_towards(kPlaces[kInputs - 1 - i]);
    });
}
void offset_naive(benchmark::State &state) {
    run(state, [](size_t i) {
        return kPlaces[i] * 30 + kDirections[i] * std::copysign(1e-4f, dot(kPlaces[kInputs - 1 - i], kDirections[i]));
    });
}
BENCHMARK(offset_robust);
BENCHMARK(offset_naive);

void ggx_d_robust(benchmark::State &state) {
    run(state, [](size_t i) { return ggx_d(kDirections[i], 0.25f); });
}
void ggx_d_naive(benchmark::State &state) {
    run(state, [](size_t i) { return naive_ggx_d(kDirections[i], 0.25f); });
}
BENCHMARK(ggx_d_robust);
BENCHMARK(ggx_d_naive);

void one_minus_exp_robust(benchmark::State &state) {
    run(state, [](size_t i) { return one_minus_exp(kPlaces[i].z); });
}
void one_minus_exp_naive(benchmark::State &state) {
    run(state, [](size_t i) { return 1 - std::exp(-kPlaces[i].z); });
}
BENCHMARK(one_minus_exp_robust);
BENCHMARK(one_minus_exp_naive);

void truncated_exponential_robust(benchmark::State &state) {
    run(state, [](size_t i) { return truncated_exponential(kBits[i], kPlaces[i].z); });
}
void truncated_exponential_naive(benchmark::State &state) {
    run(state, [](size_t i) { return naive_truncated_exponential(kNumbers[i], kPlaces[i].z); });
}
BENCHMARK(truncated_exponential_robust);
BENCHMARK(truncated_exponential_naive);

void equiangular_robust(benchmark::State &state) {
    run(state, [](size_t i) { return Equiangular(-10, 40, kPlaces[i].z * 5).sample(kNumbers[i]); });
}
void equiangular_naive(benchmark::State &state) {
    run(state, [](size_t i) { return NaiveEquiangular(-10, 40, kPlaces[i].z * 5).sample(kNumbers[i]); });
}
BENCHMARK(equiangular_robust);
BENCHMARK(equiangular_naive);

} // namespace
} // namespace glimmer
