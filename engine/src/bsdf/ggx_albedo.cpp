// SPDX-License-Identifier: GPL-3.0-or-later
#include "bsdf/ggx_albedo.h"

#include "bsdf/dielectric.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

namespace glimmer {

namespace {

// Cosines stand in the tables by their square root, widths by theirs (Blender's roughness), and indices by the fourth
// root of their reflectance at normal incidence: where these change fastest, entries are closest.
constexpr int kFine = 32, kCoarse = 16;
constexpr float kLeastCosine = 1e-4f, kLeastAlpha = 1e-3f, kMostRoot = 0.99f;

float entry(int i, int count) {
    return float(i) / float(count - 1);
}
float cosine_of(int i, int count) {
    const float t = entry(i, count);
    return std::max(t * t, kLeastCosine);
}
float alpha_of(int i, int count) {
    const float t = entry(i, count);
    return std::max(t * t, kLeastAlpha);
}
float ior_of_root(float root) {
    return (1 + root * root) / (1 - root * root);
}
float root_of_ior(float ior) {
    return std::min(std::sqrt(std::abs((ior - 1) / (ior + 1))), kMostRoot);
}
float ior_of(int i, int count) {
    return ior_of_root(entry(i, count) * kMostRoot);
}

Vec3f direction(float cosine) {
    return {std::sqrt(std::max(0.0f, (1 - cosine) * (1 + cosine))), 0, cosine};
}

/// Where and how many normals a table is summed over.
struct Quadrature {
    int azimuths, heights;
    bool crowds; ///< towards the tail of the distribution, which counts where its light is lost
};
constexpr Quadrature kMirrorNormals{16, 48, true}, kDielectricNormals{12, 24, false};

/// Calls f with visible micronormals and the part of all that each stands for: half of the azimuths, since the other
/// half mirrors them.
template <class F>
void for_each_normal(const Quadrature &q, const Vec3f &wo, float alpha, const F &f) {
    for (int i = 0; i < q.azimuths; ++i)
        for (int j = 0; j < q.heights; ++j) {
            const float rest = 1 - (float(j) + 0.5f) / float(q.heights);
            const Vec2f u{0.5f * (float(i) + 0.5f) / float(q.azimuths), 1 - (q.crowds ? rest * rest : rest)};
            f(sample_visible_normal(wo, alpha, u), (q.crowds ? 2 * rest : 1) / float(q.azimuths * q.heights));
        }
}

/// G2 / G1 where a normal reflects wo to the upper side; 0 else.
float reflected(const Vec3f &wo, const Vec3f &h, float alpha) {
    const Vec3f wi = reflect(wo, h);
    if (!(wi.z > 0))
        return 0;
    const float visible = 2 / (wo.z + ggx_projected(wo, alpha));
    return 4 * ggx_visibility(wo, wi, alpha, Masking::Smith) * wi.z / visible;
}
float transmitted(const Vec3f &wo, const Vec3f &h, float alpha, float eta) {
    const auto beyond = refract(wo, h, eta);
    if (!beyond || !(beyond->z < 0))
        return 0;
    const float visible = 2 / (wo.z + ggx_projected(wo, alpha));
    return ggx_masking_across(wo, normalize(*beyond), alpha) / (wo.z * visible);
}

struct Place {
    int below;
    float part; ///< of the way to the next entry
};
Place place(float t, int count) {
    const float x = std::clamp(t, 0.0f, 1.0f) * float(count - 1);
    const int i = std::min(int(x), count - 2);
    return {i, x - float(i)};
}
float between(float a, float b, float t) {
    return a + (b - a) * t;
}
template <class Row>
float read(const Row &row, const Place &x) {
    return between(row[size_t(x.below)], row[size_t(x.below) + 1], x.part);
}
template <class Table>
float read(const Table &table, const Place &y, const Place &x) {
    return between(read(table[size_t(y.below)], x), read(table[size_t(y.below) + 1], x), y.part);
}
template <class Table>
float read(const Table &table, const Place &z, const Place &y, const Place &x) {
    return between(read(table[size_t(z.below)], y, x), read(table[size_t(z.below) + 1], y, x), z.part);
}

template <int N>
using Row = std::array<float, size_t(N)>;
template <int Rows, int N>
using Grid = std::array<Row<N>, size_t(Rows)>;
template <int Layers, int Rows, int N>
using Block = std::array<Grid<Rows, N>, size_t(Layers)>;

/// 2 int E mu dmu with mu = t^2 is 4 int E t^3 dt, here by the trapezoidal rule.
float mean_weight(int i, int count) {
    const float t = entry(i, count), end = i == count - 1 ? 0.5f : 1.0f;
    return 4 * t * t * t * end / float(count - 1);
}

struct MirrorTables {
    Grid<kFine, kFine> albedo{}; ///< by alpha and cosine
    Row<kFine> mean{};
    Block<kCoarse, kFine, kCoarse> rise{}; ///< by alpha, cosine and index

    MirrorTables() {
        for (int a = 0; a < kFine; ++a) {
            const float alpha = alpha_of(a, kFine);
            Row<kFine> &row = albedo[size_t(a)];
            for (int c = 0; c < kFine; ++c) {
                const Vec3f wo = direction(cosine_of(c, kFine));
                for_each_normal(kMirrorNormals, wo, alpha,
                                [&](const Vec3f &h, float part) { row[size_t(c)] += part * reflected(wo, h, alpha); });
            }
            for (int c = 0; c < kFine; ++c)
                mean[size_t(a)] += mean_weight(c, kFine) * row[size_t(c)];
        }
        for (int a = 0; a < kCoarse; ++a)
            for (int c = 0; c < kFine; ++c)
                fill_rise(alpha_of(a, kCoarse), direction(cosine_of(c, kFine)), rise[size_t(a)][size_t(c)]);
    }

    static void fill_rise(float alpha, const Vec3f &wo, Row<kCoarse> &out) {
        float total = 0;
        for_each_normal(kMirrorNormals, wo, alpha, [&](const Vec3f &h, float part) {
            const float weight = part * reflected(wo, h, alpha);
            if (!(weight > 0))
                return;
            total += weight;
            for (int i = 0; i < kCoarse; ++i)
                out[size_t(i)] +=
                    weight * fresnel_rise(std::min(1.0f, dot(wo, h)), std::max(ior_of(i, kCoarse), 1 + 1e-5f));
        });
        for (float &x : out)
            x = total > 0 ? x / total : 1;
    }
};

struct DielectricTables {
    std::array<Block<kCoarse, kCoarse, kFine>, 2>
        albedo{}; ///< of denser and rarer sides beyond; by alpha, cosine and index

    std::array<Grid<kCoarse, kFine>, 2> mean{};

    DielectricTables() {
        for (size_t side = 0; side < 2; ++side)
            for (int a = 0; a < kCoarse; ++a)
                for (int c = 0; c < kCoarse; ++c) {
                    Row<kFine> &row = albedo[side][size_t(a)][size_t(c)];
                    fill(side == 1, alpha_of(a, kCoarse), direction(cosine_of(c, kCoarse)), row);
                    for (size_t i = 0; i < row.size(); ++i)
                        mean[side][size_t(a)][i] += mean_weight(c, kCoarse) * row[i];
                }
    }

    static void fill(bool inverse, float alpha, const Vec3f &wo, Row<kFine> &out) {
        for_each_normal(kDielectricNormals, wo, alpha, [&](const Vec3f &h, float part) {
            const float cosine = std::min(1.0f, dot(wo, h)), mirror = reflected(wo, h, alpha);
            for (int i = 0; i < kFine; ++i) {
                const float ior = std::max(ior_of(i, kFine), 1 + 1e-4f), eta = inverse ? 1 / ior : ior;
                const float r = fresnel_dielectric(cosine, eta);
                out[size_t(i)] += part * (r * mirror + (r < 1 ? (1 - r) * transmitted(wo, h, alpha, eta) : 0));
            }
        });
    }
};

const MirrorTables &mirror_tables() {
    static const auto tables = std::make_unique<const MirrorTables>();
    return *tables;
}
const DielectricTables &dielectric_tables() {
    static const auto tables = std::make_unique<const DielectricTables>();
    return *tables;
}

} // namespace

float ggx_albedo(float cosine, float alpha) {
    return read(mirror_tables().albedo, place(std::sqrt(alpha), kFine), place(std::sqrt(cosine), kFine));
}

float mean_ggx_albedo(float alpha) {
    return read(mirror_tables().mean, place(std::sqrt(alpha), kFine));
}

float mean_fresnel_rise(float cosine, float alpha, float ior) {
    return read(mirror_tables().rise, place(std::sqrt(alpha), kCoarse), place(std::sqrt(cosine), kFine),
                place(root_of_ior(ior) / kMostRoot, kCoarse));
}

float ggx_dielectric_albedo(float cosine, float alpha, float eta) {
    return read(dielectric_tables().albedo[eta < 1], place(std::sqrt(alpha), kCoarse),
                place(std::sqrt(cosine), kCoarse), place(root_of_ior(eta) / kMostRoot, kFine));
}

float mean_ggx_dielectric_albedo(float alpha, float eta) {
    return read(dielectric_tables().mean[eta < 1], place(std::sqrt(alpha), kCoarse),
                place(root_of_ior(eta) / kMostRoot, kFine));
}

} // namespace glimmer
