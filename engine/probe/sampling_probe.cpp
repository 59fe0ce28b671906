// SPDX-License-Identifier: GPL-3.0-or-later
#include "probe.h"
#include "sampling/alias_table.h"
#include "sampling/distribution_2d.h"
#include "sampling/sampler.h"
#include "sampling/warp.h"

using namespace glimmer;
using namespace glimmer::probe;

PROBE uint64_t probe_mix64(uint64_t x) {
    return mix64(x);
}
PROBE uint64_t probe_hash64(uint64_t a, uint64_t b) {
    return hash64(a, b);
}

/// n samplers of their own keys [n]; skip numbers, then one of each kind is drawn from copies.
PROBE void probe_sampler(uint64_t seed, const uint32_t *pixel_x, const uint32_t *pixel_y, const uint32_t *replicate,
                         const uint32_t *index, uint64_t n, uint32_t skip, uint32_t set, float *next_1d, float *next_2d,
                         float *next_exponential, uint64_t *next_bits, float *stratified_1d, float *stratified_2d,
                         uint64_t *stratified_bits) {
    for (uint64_t i = 0; i < n; ++i) {
        Sampler sampler(seed, pixel_x[i], pixel_y[i], replicate[i], index[i]);
        for (uint32_t s = 0; s < skip; ++s)
            sampler.next_1d();
        next_1d[i] = Sampler(sampler).next_1d();
        store(next_2d + 2 * i, Sampler(sampler).next_2d());
        next_exponential[i] = Sampler(sampler).next_exponential();
        next_bits[i] = Sampler(sampler).next_bits();
        stratified_1d[i] = sampler.stratified_1d(set);
        store(stratified_2d + 2 * i, sampler.stratified_2d(set));
        stratified_bits[i] = sampler.stratified_bits(set);
    }
}

/// How often of n times next_bool is true.
PROBE uint64_t probe_next_bool(uint64_t seed, float probability, uint64_t n) {
    Sampler sampler(seed, 0, 0, 0, 0);
    uint64_t count = 0;
    for (uint64_t i = 0; i < n; ++i)
        count += sampler.next_bool(probability);
    return count;
}

PROBE void probe_exponential(const uint64_t *bits, uint64_t n, float *out) {
    for (uint64_t i = 0; i < n; ++i)
        out[i] = exponential(bits[i]);
}
PROBE void probe_truncated_exponential(const uint64_t *bits, float tau, uint64_t n, float *out) {
    for (uint64_t i = 0; i < n; ++i)
        out[i] = truncated_exponential(bits[i], tau);
}

/// kind: 0 sphere, 1 cosine hemisphere, 2 cone, 3 disk (z = 0), 4 triangle barycentrics. pdf as the twin gives it.
PROBE void probe_warp(int kind, float parameter, const float *u, uint64_t n, float *out, float *pdf) {
    for (uint64_t i = 0; i < n; ++i) {
        const Vec2f v = load2(u + 2 * i);
        Vec3f p;
        if (kind == 0) {
            p = sample_uniform_sphere(v), pdf[i] = pdf_uniform_sphere();
        } else if (kind == 1) {
            p = sample_cosine_hemisphere(v), pdf[i] = pdf_cosine_hemisphere(p.z);
        } else if (kind == 2) {
            p = sample_uniform_cone(parameter, v), pdf[i] = pdf_uniform_cone(parameter);
        } else if (kind == 3) {
            const Vec2f d = sample_uniform_disk(v);
            p = {d.x, d.y, 0}, pdf[i] = pdf_uniform_disk();
        } else {
            const Barycentrics b = sample_triangle_barycentrics(v);
            p = {b.b0, b.b1, b.b2}, pdf[i] = pdf_triangle_barycentrics();
        }
        store(out + 3 * i, p);
    }
}

PROBE float probe_one_minus_cos(float s) {
    return one_minus_cos_of_sine(s);
}

/// weights [count]; u, fine, index, pmf, rest [n]; all_pmf [count]. Returns 0 for an empty table.
PROBE int probe_alias_table(const double *weights, uint64_t count, const float *u, const float *fine, uint64_t n,
                            uint32_t *index, float *pmf, float *all_pmf, float *rest) {
    const AliasTable table({weights, count});
    if (table.empty())
        return 0;
    for (uint64_t i = 0; i < n; ++i) {
        const AliasSample s = table.sample(u[i], fine[i]);
        index[i] = s.index;
        pmf[i] = s.pmf;
        rest[i] = s.rest;
    }
    for (uint32_t i = 0; i < count; ++i)
        all_pmf[i] = table.pmf(i);
    return 1;
}

/// weights [height, width]; u, uv [n, 2]; pdf and pdf_twin (pdf(uv)) [n]; texel_pdf [height, width]. Returns 0 for an
/// empty one.
PROBE int probe_distribution_2d(const float *weights, uint64_t width, uint64_t height, const float *u, uint64_t n,
                                float *uv, float *pdf, float *pdf_twin, float *texel_pdf) {
    const Distribution2d distribution({weights, width * height}, width, height);
    if (distribution.empty())
        return 0;
    for (uint64_t i = 0; i < n; ++i) {
        const Distribution2dSample s = distribution.sample(load2(u + 2 * i));
        store(uv + 2 * i, s.uv);
        pdf[i] = s.pdf;
        pdf_twin[i] = distribution.pdf(s.uv);
    }
    for (uint64_t y = 0; y < height; ++y)
        for (uint64_t x = 0; x < width; ++x)
            texel_pdf[y * width + x] = distribution.pdf({(static_cast<float>(x) + 0.5f) / static_cast<float>(width),
                                                         (static_cast<float>(y) + 0.5f) / static_cast<float>(height)});
    return 1;
}
