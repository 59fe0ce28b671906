// SPDX-License-Identifier: GPL-3.0-or-later
#include "bsdf/bsdf.h"
#include "bsdf/dielectric.h"
#include "bsdf/ggx_albedo.h"
#include "probe.h"

#include <cmath>
#include <vector>

using namespace glimmer;
using namespace glimmer::probe;

struct probe_lobe {
    // 0 Lambert, 1 mirror, 2 conductor, 3 report metal, 4 dielectric, 5 transparent, 6 translucent, 7 Oren-Nayar, 8
    // Burley, 9 sheen, 10 brushed, 11 subsurface
    int32_t type;
    // flag: Schlick of a dielectric, multiple scattering of what else is rough, the model of a sheen; above: see
    // WeightedLobe; of Burley the part, of subsurface the model, its masking the entry
    int32_t use_f0, masking, flag, above;
    float weight, alpha, cover; // alpha: roughness of what is diffuse
    // Of a dielectric: transmission, (ior, 0: refraction only, 1: multiple scattering), -, reflection. eta of what is
    // brushed: both widths, the turn of the tangent.
    float color[3], eta[3], k[3], f0[3];
    float curve_ior, f82[3]; // of a conductor; of subsurface f0 is the radius, curve_ior the anisotropy
};

/// eta: index beyond / index on the side of wo.
struct Surface {
    std::vector<WeightedLobe> lobes;
    Bsdf bsdf;
};
static Subsurface subsurface(const probe_lobe &l) {
    return {load_rgb(l.color),
            load_rgb(l.f0),
            Rgb(1),
            l.curve_ior,
            l.eta[0],
            l.alpha,
            static_cast<SubsurfaceModel>(l.flag),
            static_cast<SubsurfaceEntry>(l.masking)};
}
static Surface make(const probe_lobe *lobes, uint64_t count, float eta) {
    Surface surface;
    std::vector<WeightedLobe> &out = surface.lobes;
    for (uint64_t i = 0; i < count; ++i) {
        const probe_lobe &l = lobes[i];
        Lobe lobe;
        if (l.type == 0)
            lobe = Lambert{load_rgb(l.color)};
        else if (l.type == 1)
            lobe = Mirror{load_rgb(l.color)};
        else if (l.type == 2)
            lobe = Conductor{l.alpha,       l.use_f0 != 0,   load_rgb(l.eta),
                             load_rgb(l.k), load_rgb(l.f0),  static_cast<Masking>(l.masking),
                             Rgb(1),        load_rgb(l.f82), l.curve_ior,
                             l.flag != 0};
        else if (l.type == 3)
            lobe = BaselineMetal{load_rgb(l.color), load_rgb(l.f0), l.alpha};
        else if (l.type == 4)
            lobe = Dielectric{l.eta[0],       l.alpha,           l.flag != 0,  l.eta[1] != 0,
                              load_rgb(l.f0), load_rgb(l.color), l.eta[2] == 1};
        else if (l.type == 5)
            lobe = Transparent{load_rgb(l.color)};
        else if (l.type == 6)
            lobe = Translucent{load_rgb(l.color)};
        else if (l.type == 7)
            lobe = OrenNayar{load_rgb(l.color), l.alpha, l.flag != 0};
        else if (l.type == 8)
            lobe = Burley{load_rgb(l.color), l.alpha, static_cast<BurleyPart>(l.flag)};
        else if (l.type == 9)
            lobe = Sheen{load_rgb(l.color), l.alpha, static_cast<SheenModel>(l.flag)};
        else if (l.type == 11)
            lobe = subsurface(l);
        else
            lobe = Brushed{Conductor{std::sqrt(l.eta[0] * l.eta[1]),
                                     true,
                                     {},
                                     {},
                                     load_rgb(l.f0),
                                     Masking::Smith,
                                     Rgb(1),
                                     Rgb(1),
                                     0,
                                     l.flag != 0},
                           l.eta[0],
                           l.eta[1],
                           {},
                           0,
                           circle_point(1, l.eta[2])};
        out.push_back({lobe, l.weight, 0, uint32_t(l.above), l.cover});
    }
    set_probabilities(out);
    surface.bsdf = Bsdf(out);
    surface.bsdf.eta = eta;
    return surface;
}

/// Coefficients of what a body of the lobe is filled with: extinction, albedo and weight of what enters, [3] each.
PROBE void probe_subsurface_medium(const probe_lobe *lobe, float *sigma_t, float *alpha, float *weight) {
    const SubsurfaceMedium medium = subsurface_medium(subsurface(*lobe));
    store(sigma_t, medium.sigma_t);
    store(alpha, medium.alpha);
    store(weight, medium.weight);
}

/// wo [3]; wi [n, 3]; f [n, 3], pdf [n].
PROBE void probe_bsdf_eval(const probe_lobe *lobes, uint64_t count, float eta, const float *wo, const float *wi,
                           uint64_t n, float *f, float *pdf_out) {
    const Surface surface = make(lobes, count, eta);
    for (uint64_t i = 0; i < n; ++i) {
        store(f + 3 * i, eval(surface.bsdf, load3(wo), load3(wi + 3 * i)));
        pdf_out[i] = pdf(surface.bsdf, load3(wo), load3(wi + 3 * i));
    }
}

/// result [n]: 0 nothing, 1 smooth, 2 specular; 4 more where transmitted.
PROBE void probe_bsdf_sample(const probe_lobe *lobes, uint64_t count, float eta, const float *wo, const float *u_lobe,
                             const float *u, uint64_t n, float *wi, float *weight, float *pdf_out, int32_t *result) {
    const Surface surface = make(lobes, count, eta);
    for (uint64_t i = 0; i < n; ++i) {
        const auto s = sample(surface.bsdf, load3(wo), u_lobe[i], load2(u + 2 * i));
        result[i] = !s ? 0 : (s->specular ? 2 : 1) + (s->transmitted ? 4 : 0);
        if (!s)
            continue;
        store(wi + 3 * i, s->wi);
        store(weight + 3 * i, s->weight);
        pdf_out[i] = s->pdf;
    }
}

/// The weights [n, 3] that the samples of probe_bsdf_sample have where light flows the other way; 0 where there is
/// none.
PROBE void probe_bsdf_adjoint(const probe_lobe *lobes, uint64_t count, float eta, const float *wo, const float *u_lobe,
                              const float *u, uint64_t n, float *weight) {
    const Surface surface = make(lobes, count, eta);
    for (uint64_t i = 0; i < n; ++i)
        if (const auto s = sample(surface.bsdf, load3(wo), u_lobe[i], load2(u + 2 * i)))
            store(weight + 3 * i, adjoint_weight(surface.bsdf, load3(wo), *s));
}

/// kind: 0 GGX, 1 its mean, 2 rise of Fresnel's reflectance, 3 dielectric. cosine, alpha, ior, out: [n].
PROBE void probe_ggx_albedo(int kind, const float *cosine, const float *alpha, const float *ior, uint64_t n,
                            float *out) {
    for (uint64_t i = 0; i < n; ++i)
        out[i] = kind == 0   ? ggx_albedo(cosine[i], alpha[i])
                 : kind == 1 ? mean_ggx_albedo(alpha[i])
                 : kind == 2 ? mean_fresnel_rise(cosine[i], alpha[i], ior[i])
                             : ggx_dielectric_albedo(cosine[i], alpha[i], ior[i]);
}

/// select [count], albedo [3], flags [2]: is_specular, has_specular; max_value [1].
PROBE void probe_bsdf_describe(const probe_lobe *lobes, uint64_t count, float *probability, float *albedo_out,
                               int32_t *flags, float *max_value_out) {
    const Surface surface = make(lobes, count, 1);
    for (uint64_t i = 0; i < count; ++i)
        probability[i] = surface.lobes[i].probability;
    store(albedo_out, albedo(surface.bsdf));
    flags[0] = is_specular(surface.bsdf);
    flags[1] = has_specular(surface.bsdf);
    *max_value_out = max_value(surface.bsdf);
}

/// kind: 0 conductor, 1 dielectric, 2 Schlick from f0 = eta to f90 = k, 3 dielectric by Schlick.
PROBE void probe_fresnel(int kind, const float *cos_i, const float *eta, const float *k, uint64_t n, float *out) {
    for (uint64_t i = 0; i < n; ++i)
        out[i] = kind == 0   ? fresnel_conductor(cos_i[i], eta[i], k[i])
                 : kind == 1 ? fresnel_dielectric(cos_i[i], eta[i])
                 : kind == 2 ? fresnel_schlick(cos_i[i], Rgb(eta[i]), Rgb(k[i])).r
                             : fresnel_dielectric_schlick(cos_i[i], eta[i]);
}

PROBE void probe_ggx_d(const float *h, float alpha, uint64_t n, float *out) {
    for (uint64_t i = 0; i < n; ++i)
        out[i] = ggx_d(load3(h + 3 * i), alpha);
}

PROBE void probe_glass(const float *wo, const float *eta, int schlick, const float *u, uint64_t n, float *wi,
                       float *weight, float *probability, int32_t *transmitted) {
    for (uint64_t i = 0; i < n; ++i) {
        const auto s = sample(Dielectric{.ior = eta[i], .schlick = schlick != 0}, load3(wo + 3 * i), {}, eta[i], u[i]);
        store(wi + 3 * i, s->wi);
        store(weight + 3 * i, s->weight);
        probability[i] = s->pdf;
        transmitted[i] = s->transmitted;
    }
}
