// SPDX-License-Identifier: GPL-3.0-or-later
// A surface's BSDF: a weighted sum of lobes, some of which may lie beneath others. See bsdf/sample.h for the
// conventions.
#pragma once

#include "bsdf/baseline_metal.h"
#include "bsdf/brushed.h"
#include "bsdf/bump.h"
#include "bsdf/burley.h"
#include "bsdf/conductor.h"
#include "bsdf/dielectric.h"
#include "bsdf/lambert.h"
#include "bsdf/mirror.h"
#include "bsdf/oren_nayar.h"
#include "bsdf/sample.h"
#include "bsdf/sheen.h"
#include "bsdf/subsurface.h"
#include "bsdf/translucent.h"
#include "bsdf/transparent.h"

#include <bit>
#include <optional>
#include <span>
#include <variant>

namespace glimmer {

using Lobe = std::variant<Lambert, Mirror, Conductor, BaselineMetal, Dielectric, Transparent, Translucent, OrenNayar,
                          Burley, Sheen, Brushed, Subsurface>;

namespace lobes {

template <size_t I, class F>
[[gnu::always_inline]] inline std::invoke_result_t<F &, const Lambert &> call_with(F &f, const Lobe &lobe) {
    if constexpr (I < std::variant_size_v<Lobe>)
        return f(*std::get_if<I>(&lobe));
    else
        __builtin_unreachable();
}

/// std::visit, which from twelve alternatives on would call through a table in place of a switch.
template <class F>
[[gnu::always_inline]] inline auto visit(F &&f, const Lobe &lobe) {
    static_assert(std::variant_size_v<Lobe> <= 16);
    switch (lobe.index()) {
    case 0:
        return call_with<0>(f, lobe);
    case 1:
        return call_with<1>(f, lobe);
    case 2:
        return call_with<2>(f, lobe);
    case 3:
        return call_with<3>(f, lobe);
    case 4:
        return call_with<4>(f, lobe);
    case 5:
        return call_with<5>(f, lobe);
    case 6:
        return call_with<6>(f, lobe);
    case 7:
        return call_with<7>(f, lobe);
    case 8:
        return call_with<8>(f, lobe);
    case 9:
        return call_with<9>(f, lobe);
    case 10:
        return call_with<10>(f, lobe);
    case 11:
        return call_with<11>(f, lobe);
    case 12:
        return call_with<12>(f, lobe);
    case 13:
        return call_with<13>(f, lobe);
    case 14:
        return call_with<14>(f, lobe);
    case 15:
        return call_with<15>(f, lobe);
    default:
        __builtin_unreachable();
    }
}

} // namespace lobes

struct WeightedLobe {
    Lobe lobe;
    float weight;       ///< factor of the lobe in the sum, >= 0
    float probability;  ///< probability of sampling it; sums to 1 over a Bsdf (see set_probabilities)
    uint32_t above = 0; ///< a bit for each of the Bsdf's first lobes that lie above this one and keep light from it
    float cover = 1;    ///< part of what lies beneath that this lobe is above of

    static constexpr uint32_t kMostAbove = 32;
};

/// A view; the lobes live in the scene or in an arena. May be empty (black).
class Bsdf : public std::span<const WeightedLobe> {
  public:
    using std::span<const WeightedLobe>::span;
    explicit Bsdf(std::span<const WeightedLobe> lobes) : std::span<const WeightedLobe>(lobes) {}
    float eta = 1; ///< index on the other side / index on the side of wo: 1 but at the boundary of a dielectric
    const BumpShadow *bump = nullptr; ///< what diffuse lobes lose; null: nothing
};

inline bool is_specular(const Lobe &lobe) {
    return lobes::visit([](const auto &l) { return is_specular(l); }, lobe);
}
inline Rgb albedo(const Lobe &lobe) {
    return lobes::visit([](const auto &l) { return albedo(l); }, lobe);
}
inline float max_value(const Lobe &lobe) {
    return lobes::visit([](const auto &l) { return max_value(l); }, lobe);
}
/// Part of the light towards wo that a lobe keeps from what lies beneath it.
inline float coverage(const Lobe &lobe, const Vec3f &wo) {
    return lobes::visit(
        [&]<class T>(const T &l) {
            if constexpr (std::is_same_v<T, Conductor> || std::is_same_v<T, Brushed> || std::is_same_v<T, Sheen>)
                return std::min(max_component(coverage(l, wo)), 1.0f);
            else
                return std::min(max_component(albedo(l)), 1.0f);
        },
        lobe);
}
/// Part of the light towards wo that the lobes above one leave to it.
[[gnu::noinline]] inline float uncovered(const Bsdf &bsdf, const WeightedLobe &lobe, const Vec3f &wo) {
    float share = 1;
    for (uint32_t above = lobe.above; above; above &= above - 1) {
        const WeightedLobe &a = bsdf[size_t(std::countr_zero(above))];
        share *= std::max(0.0f, 1 - a.cover * coverage(a.lobe, wo));
    }
    return share;
}
/// The lobe's factor in the sum as it is seen from wo.
inline float weight_towards(const Bsdf &bsdf, const WeightedLobe &lobe, const Vec3f &wo) {
    return lobe.above ? lobe.weight * uncovered(bsdf, lobe, wo) : lobe.weight;
}
/// Whether f(wo, wi) is f(wi, wo).
inline bool is_reciprocal(const Bsdf &bsdf) {
    if (bsdf.bump)
        return false;
    for (const WeightedLobe &l : bsdf) {
        const auto *metal = std::get_if<Conductor>(&l.lobe);
        const auto *dielectric = std::get_if<Dielectric>(&l.lobe);
        const auto *sheen = std::get_if<Sheen>(&l.lobe);
        const auto *brushed = std::get_if<Brushed>(&l.lobe);
        if (l.above || (brushed && brushed->metal.multiple_scattering) || (metal && metal->multiple_scattering) ||
            (dielectric && dielectric->multiple_scattering) || (sheen && sheen->model == SheenModel::fibers))
            return false;
    }
    return true;
}
/// Whether light passes to the other side.
inline bool transmits(const Lobe &lobe) {
    return std::holds_alternative<Dielectric>(lobe) || std::holds_alternative<Transparent>(lobe) ||
           std::holds_alternative<Translucent>(lobe);
}

inline bool is_diffuse(const Lobe &lobe) {
    return std::holds_alternative<Lambert>(lobe) || std::holds_alternative<OrenNayar>(lobe) ||
           std::holds_alternative<Translucent>(lobe) || std::holds_alternative<Burley>(lobe) ||
           std::holds_alternative<Sheen>(lobe) || std::holds_alternative<Subsurface>(lobe);
}

template <class T>
inline constexpr bool kNeedsEta = std::is_same_v<T, Dielectric>;

/// Metal, which most surfaces here are, without a jump to what it is.
inline Rgb eval(const Lobe &lobe, const Vec3f &wo, const Vec3f &wi, float eta) {
    if (const auto *metal = std::get_if<Conductor>(&lobe)) [[likely]]
        return eval(*metal, wo, wi);
    return lobes::visit(
        [&]<class T>(const T &l) {
            if constexpr (kNeedsEta<T>)
                return eval(l, wo, wi, eta);
            else
                return eval(l, wo, wi);
        },
        lobe);
}
inline float pdf(const Lobe &lobe, const Vec3f &wo, const Vec3f &wi, float eta) {
    if (const auto *metal = std::get_if<Conductor>(&lobe)) [[likely]]
        return pdf(*metal, wo, wi);
    return lobes::visit(
        [&]<class T>(const T &l) {
            if constexpr (kNeedsEta<T>)
                return pdf(l, wo, wi, eta);
            else
                return pdf(l, wo, wi);
        },
        lobe);
}
/// u_choice: for lobes that both reflect and transmit.
inline std::optional<BsdfSample> sample(const Lobe &lobe, const Vec3f &wo, Vec2f u, float eta, float u_choice) {
    return lobes::visit(
        [&]<class T>(const T &l) {
            if constexpr (kNeedsEta<T>)
                return sample(l, wo, u, eta, u_choice);
            else
                return sample(l, wo, u);
        },
        lobe);
}

/// What bumps leave of a lobe's light from wi.
inline float bump_factor(const Bsdf &bsdf, const Lobe &lobe, const Vec3f &wi) {
    return bsdf.bump && is_diffuse(lobe) ? bump_shadow(*bsdf.bump, wi) : 1.0f;
}

/// The same sum of the lobes that reflect diffusely, that reflect otherwise, or that transmit: those that are asked
/// for.
inline Rgb eval(const Bsdf &bsdf, const Vec3f &wo, const Vec3f &wi, bool diffuse, bool glossy, bool transmission) {
    Rgb sum;
    for (const WeightedLobe &l : bsdf)
        if (wi.z < 0 ? transmission : is_diffuse(l.lobe) ? diffuse : glossy)
            sum += eval(l.lobe, wo, wi, bsdf.eta) * (weight_towards(bsdf, l, wo) * bump_factor(bsdf, l.lobe, wi));
    return sum;
}

/// f |cos_i| of the smooth lobes.
inline Rgb eval(const Bsdf &bsdf, const Vec3f &wo, const Vec3f &wi) {
    if (bsdf.bump) [[unlikely]]
        return eval(bsdf, wo, wi, true, true, true);
    Rgb sum;
    for (const WeightedLobe &l : bsdf)
        sum += eval(l.lobe, wo, wi, bsdf.eta) * weight_towards(bsdf, l, wo);
    return sum;
}

/// Density with which sample() returns wi from a smooth lobe.
inline float pdf(const Bsdf &bsdf, const Vec3f &wo, const Vec3f &wi) {
    float sum = 0;
    for (const WeightedLobe &l : bsdf)
        if (l.probability > 0)
            sum += pdf(l.lobe, wo, wi, bsdf.eta) * l.probability;
    return sum;
}

/// A direction of a smooth lobe comes with the weight of all smooth lobes, eval/pdf; one of a specular lobe with that
/// lobe's own weight over its probability.
inline std::optional<BsdfSample> sample(const Bsdf &bsdf, const Vec3f &wo, float u_lobe, Vec2f u) {
    const WeightedLobe *chosen = nullptr;
    float u_choice = 0; // where u_lobe stands within the chosen lobe's share, 0 to 1
    int smooth = 0;
    for (const WeightedLobe &l : bsdf) {
        smooth += !is_specular(l.lobe);
        if (l.probability > 0 && u_lobe >= 0) {
            chosen = &l; // the last possible one stands if rounding lets u_lobe outlast the sum
            u_choice = u_lobe / l.probability;
            u_lobe -= l.probability;
        }
    }
    if (!chosen)
        return std::nullopt;
    std::optional<BsdfSample> s = sample(chosen->lobe, wo, u, bsdf.eta, std::min(u_choice, 0x1.fffffep-1f));
    if (!s)
        return std::nullopt;
    s->diffuse = is_diffuse(chosen->lobe);
    s->lobe = uint32_t(chosen - bsdf.data());
    if (s->specular || smooth == 1) {
        s->weight *= weight_towards(bsdf, *chosen, wo) / chosen->probability;
        s->pdf *= chosen->probability;
        if (bsdf.bump && !s->specular) [[unlikely]]
            s->weight *= bump_factor(bsdf, chosen->lobe, s->wi);
        return s;
    }
    const float density = pdf(bsdf, wo, s->wi);
    if (!(density > 0))
        return std::nullopt;
    return BsdfSample{s->wi, eval(bsdf, wo, s->wi) / density, density, false, s->transmitted, s->diffuse, s->lobe};
}

/// Whether some light passes to the other side in all directions.
inline bool is_translucent(const Bsdf &bsdf) {
    for (const WeightedLobe &l : bsdf)
        if (std::holds_alternative<Translucent>(l.lobe))
            return true;
    return false;
}

/// The weight of a sample drawn for wo where light comes from wo and leaves to s.wi, about the same normal: f that is
/// seen from s.wi times |cos| of s.wi over the density. Of what is refracted, and of that alone, the two sides see f
/// by eta^2 apart.
inline Rgb adjoint_weight(const Bsdf &bsdf, const Vec3f &wo, const BsdfSample &s) {
    const bool refracted = s.transmitted && std::holds_alternative<Dielectric>(bsdf[s.lobe].lobe);
    const float scale = refracted ? 1 / (bsdf.eta * bsdf.eta) : 1;
    if (is_reciprocal(bsdf) && (bsdf.eta == 1 || !s.transmitted || s.specular || !is_translucent(bsdf)))
        return s.weight * scale;
    Bsdf there = bsdf; // as it is seen from s.wi
    Vec3f out = s.wi, in = wo;
    if (s.transmitted) {
        there.eta = 1 / bsdf.eta;
        out.z = -out.z;
        in.z = -in.z;
    }
    if (s.specular) {
        const float seen = uncovered(bsdf, bsdf[s.lobe], wo);
        return seen > 0 ? s.weight * (scale * uncovered(there, bsdf[s.lobe], out) / seen) : Rgb();
    }
    return eval(there, out, in) * (out.z / std::abs(in.z) / s.pdf);
}

/// Delta lobes alone: light sampling finds nothing here.
inline bool is_specular(const Bsdf &bsdf) {
    for (const WeightedLobe &l : bsdf)
        if (!is_specular(l.lobe))
            return false;
    return true;
}
/// Mirrors and smooth glass.
inline bool has_specular(const Bsdf &bsdf) {
    for (const WeightedLobe &l : bsdf)
        if (is_specular(l.lobe) && !std::holds_alternative<Subsurface>(l.lobe))
            return true;
    return false;
}

inline bool has_subsurface(const Bsdf &bsdf) {
    for (const WeightedLobe &l : bsdf)
        if (std::holds_alternative<Subsurface>(l.lobe))
            return true;
    return false;
}

inline bool transmits(const Bsdf &bsdf) {
    for (const WeightedLobe &l : bsdf)
        if (transmits(l.lobe))
            return true;
    return false;
}
/// The boundary of smooth glass and nothing else, which one number samples.
inline bool is_smooth_dielectric(const Bsdf &bsdf) {
    return bsdf.size() == 1 && std::holds_alternative<Dielectric>(bsdf[0].lobe) && is_specular(bsdf[0].lobe);
}

/// No f cos_o of any channel is larger: what bounds the light that a surface can throw at a point. Infinite with
/// mirrors.
inline float max_value(const Bsdf &bsdf) {
    float sum = 0;
    for (const WeightedLobe &l : bsdf)
        if (l.weight > 0)
            sum += l.weight * max_value(l.lobe);
    return sum;
}

/// Reflectance for the albedo AOV: an approximation that knows no direction.
inline Rgb albedo(const Bsdf &bsdf) {
    Rgb sum;
    for (const WeightedLobe &l : bsdf)
        sum += albedo(l.lobe) * weight_towards(bsdf, l, {0, 0, 1});
    return sum;
}

/// Sets the probabilities of selection: nine tenths by weight times largest albedo, one tenth shared equally by the
/// lobes that have weight (a metal that is black at normal incidence is not at grazing).
inline void set_probabilities(std::span<WeightedLobe> lobes) {
    float total = 0;
    int count = 0;
    for (const WeightedLobe &l : lobes) {
        total += l.weight * max_component(albedo(l.lobe));
        count += l.weight > 0;
    }
    for (WeightedLobe &l : lobes) {
        if (!(l.weight > 0))
            l.probability = 0;
        else if (total > 0)
            l.probability = 0.9f * l.weight * max_component(albedo(l.lobe)) / total + 0.1f / static_cast<float>(count);
        else
            l.probability = 1 / static_cast<float>(count);
    }
}

} // namespace glimmer
