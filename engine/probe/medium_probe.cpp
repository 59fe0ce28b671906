// SPDX-License-Identifier: GPL-3.0-or-later
#include "medium/equiangular.h"
#include "medium/homogeneous_medium.h"
#include "medium/phase.h"
#include "probe.h"

using namespace glimmer;
using namespace glimmer::probe;

static HomogeneousMedium medium(const float *sigma) {
    return {load_rgb(sigma), load_rgb(sigma + 3), 0};
}

/// sigma [2, 3]: absorption, scattering; t [n]; out [n, 3].
PROBE void probe_transmittance(const float *sigma, const float *t, uint64_t n, float *out) {
    for (uint64_t i = 0; i < n; ++i)
        store(out + 3 * i, medium(sigma).transmittance(t[i]));
}

/// u_channel, bits, t, scattered, pdf [n]; weight [n, 3]. With through_sampler the numbers come from Sampler(bits[i],
/// 0, 0, 0, 0).
PROBE void probe_free_flight(const float *sigma, const float *beta, float t_max, const float *u_channel,
                             const uint64_t *bits, int through_sampler, uint64_t n, float *t, int32_t *scattered,
                             float *weight, float *pdf) {
    const HomogeneousMedium m = medium(sigma);
    for (uint64_t i = 0; i < n; ++i) {
        Sampler sampler(bits[i], 0, 0, 0, 0);
        const FreeFlight f = through_sampler ? sample_free_flight(m, load_rgb(beta), t_max, sampler)
                                             : sample_free_flight(m, load_rgb(beta), t_max, u_channel[i], bits[i]);
        t[i] = f.t;
        scattered[i] = f.scattered;
        store(weight + 3 * i, f.weight);
        pdf[i] = f.pdf;
    }
}
PROBE void probe_free_flight_pdf(const float *sigma, const float *beta, const float *t, uint64_t n, float *pdf) {
    for (uint64_t i = 0; i < n; ++i)
        pdf[i] = free_flight_pdf(medium(sigma), load_rgb(beta), t[i]);
}

PROBE void probe_collision(const float *sigma, const float *beta, float t_max, const float *u_channel,
                           const uint64_t *bits, int through_sampler, uint64_t n, float *t, float *weight, float *pdf) {
    const HomogeneousMedium m = medium(sigma);
    for (uint64_t i = 0; i < n; ++i) {
        Sampler sampler(bits[i], 0, 0, 0, 0);
        const Collision c = through_sampler ? sample_collision(m, load_rgb(beta), t_max, sampler)
                                            : sample_collision(m, load_rgb(beta), t_max, u_channel[i], bits[i]);
        t[i] = c.t;
        store(weight + 3 * i, c.weight);
        pdf[i] = c.pdf;
    }
}
PROBE void probe_collision_pdf(const float *sigma, const float *beta, float t_max, const float *t, uint64_t n,
                               float *pdf) {
    for (uint64_t i = 0; i < n; ++i)
        pdf[i] = collision_pdf(medium(sigma), load_rgb(beta), t_max, t[i]);
}

/// before [3]; u [n, 2]; direction [n, 3], pdf [n].
PROBE void probe_phase_sample(float g, const float *before, const float *u, uint64_t n, float *direction, float *pdf) {
    for (uint64_t i = 0; i < n; ++i) {
        const PhaseSample s = HenyeyGreenstein{g}.sample(load3(before), load2(u + 2 * i));
        store(direction + 3 * i, s.direction);
        pdf[i] = s.pdf;
    }
}
PROBE void probe_phase_cos(float g, const float *cosine, uint64_t n, float *out) {
    for (uint64_t i = 0; i < n; ++i)
        out[i] = HenyeyGreenstein{g}.eval(cosine[i]);
}
PROBE void probe_phase_directions(float g, const float *before, const float *after, uint64_t n, float *out) {
    for (uint64_t i = 0; i < n; ++i)
        out[i] = HenyeyGreenstein{g}.eval(load3(before), load3(after + 3 * i));
}

PROBE void probe_equiangular(float a, float b, float h, const float *u, uint64_t n, float *t) {
    for (uint64_t i = 0; i < n; ++i)
        t[i] = sample_equiangular(a, b, h, u[i]);
}
PROBE void probe_equiangular_pdf(float a, float b, float h, const float *t, uint64_t n, float *pdf) {
    for (uint64_t i = 0; i < n; ++i)
        pdf[i] = pdf_equiangular(a, b, h, t[i]);
}
