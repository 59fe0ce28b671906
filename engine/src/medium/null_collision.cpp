// SPDX-License-Identifier: GPL-3.0-or-later
// Tracking through media that vary (docs/method.md, section 15). Along a ray collisions are looked for at the rate of
// majorants; what is not extinction there is a null collision, which changes nothing but the weight. Weights follow the
// history of each channel (Kutz et al. 2017, Spectral and decomposition tracking). The coefficients that do not vary
// never take part as absorption: they are known along the ray, and decided in closed form (the decomposition of that
// paper). Transmittance is estimated by ratio tracking (Novák et al. 2014).
//
// Nothing here needs the majorants to be bounds. Where a medium is denser, the weight of a null collision is negative
// and larger than it would be, and its mean is still right (Galtier et al. 2013).
#include "medium/bounded_media.h"

#include <algorithm>

namespace glimmer {

namespace {

// Weights that have fallen below this are played for: each step costs a program, and they bring little.
constexpr float kLeastWeight = .1f;
// Expected looks at the emission of a piece of a ray, at least.
constexpr float kLooksAtEmission = 8;
// By rounding alone a medium may be so much denser than its majorant.
constexpr float kRounding = 1e-4f;

Rgb absolute(const Rgb &c) {
    return {std::abs(c.r), std::abs(c.g), std::abs(c.b)};
}

Rgb attenuated(const Rgb &weight, const Rgb &sigma, float length) {
    return is_black(sigma) ? weight : weight * exp_minus(detail::depths(sigma, length));
}

/// Russian roulette of a small weight; false: it is gone.
bool survives(Rgb &weight, Sampler &sampler) {
    const float size = max_component(absolute(weight));
    if (size >= kLeastWeight)
        return true;
    if (!(size > 0) || sampler.next_1d() * kLeastWeight >= size)
        return false;
    weight *= kLeastWeight / size;
    return true;
}

} // namespace

/// visit(piece, begin, end, majorant) for parts of the ray with one majorant of what varies, until it returns false.
template <class Visit>
void BoundedMedia::for_each_interval(const Ray &ray, float t_max, const Visit &visit) const {
    thread_local std::vector<MajorantGrid::Walk> walks;
    const RayMedia &media = along(ray);
    for (const MediumPiece &piece : media.pieces) {
        if (piece.begin >= t_max)
            return;
        const float end = std::min(piece.end, t_max);
        if (!piece.varies) {
            if (!visit(piece, piece.begin, end, 0.0f))
                return;
            continue;
        }
        walks.clear();
        for (uint32_t k = 0; k < piece.count; ++k)
            if (const MediumPart &part = media.parts[piece.first + k]; media_[part.medium].varies) {
                const BodyFrame frame =
                    boundaries_->moves() ? boundaries_->frame(part.body, ray.time) : varying_->frames[part.body];
                walks.emplace_back(*varying_->grids[part.body], frame.point(ray.origin), frame.vector(ray.direction),
                                   piece.begin, end);
            }
        for (float begin = piece.begin; begin < end;) {
            float next = end, majorant = 0;
            for (const MajorantGrid::Walk &walk : walks) {
                next = std::min(next, walk.end());
                majorant += walk.majorant();
            }
            if (next > begin && !visit(piece, begin, next, majorant))
                return;
            begin = std::max(begin, next);
            for (MajorantGrid::Walk &walk : walks)
                if (walk.end() <= next && next < end)
                    walk.next();
        }
    }
}

MediumPoint BoundedMedia::sum_at(const RayMedia &media, const MediumPiece &piece, const Ray &ray, float t,
                                 float majorant) const {
    MediumPoint sum;
    for (uint32_t k = 0; k < piece.count; ++k)
        if (const MediumPart &part = media.parts[piece.first + k]; media_[part.medium].varies) {
            const MediumPoint point = at(part, ray, t);
            sum.sigma_a += point.sigma_a;
            sum.sigma_s += point.sigma_s;
            sum.emission += point.emission;
        }
    if (max_component(sum.sigma_t()) > majorant * (1 + kRounding))
        varying_->exceeded.fetch_add(1, std::memory_order_relaxed);
    return sum;
}

Rgb BoundedMedia::estimate_transmittance(const Ray &ray, float t_max, Sampler &sampler) const {
    const RayMedia &media = along(ray);
    Rgb weight(1), depth; // of what varies, and of what does not
    for_each_interval(ray, t_max, [&](const MediumPiece &piece, float begin, float end, float majorant) {
        depth += detail::depths(piece.sigma_t, end - begin);
        for (float t = begin; majorant > 0;) {
            t += exponential(sampler.next_bits()) / majorant;
            if (!(t < end))
                break;
            weight *= Rgb(1) - sum_at(media, piece, ray, t, majorant).sigma_t() * (1 / majorant);
            if (!survives(weight, sampler)) {
                weight = Rgb(0);
                return false;
            }
        }
        return true;
    });
    return is_black(weight) ? Rgb(0) : weight * exp_minus(depth);
}

FreeFlight BoundedMedia::estimate_free_flight(const Ray &ray, const Rgb &beta, float t_max, Sampler &sampler) const {
    const RayMedia &media = along(ray);
    FreeFlight flight{t_max, false, Rgb(1), 1};
    Rgb &weight = flight.weight;
    for_each_interval(ray, t_max, [&](const MediumPiece &piece, float begin, float end, float majorant) {
        const float rate = max_component(piece.sigma_s) + majorant;
        for (float t = begin;;) {
            const float step = rate > 0 ? exponential(sampler.next_bits()) / rate : kInfinity;
            if (!(t + step < end)) {
                weight = attenuated(weight, piece.sigma_a, end - t);
                return true;
            }
            t += step;
            weight = attenuated(weight, piece.sigma_a, step);
            MediumPoint point;
            if (piece.varies)
                point = sum_at(media, piece, ray, t, majorant);
            const Rgb scattering = piece.sigma_s + point.sigma_s, null = Rgb(rate) - scattering - point.sigma_a;
            const Rgb carried = absolute(beta * weight);
            const float scattered = detail::sum(carried * scattering), passed = detail::sum(carried * absolute(null));
            const float all = scattered + passed;
            if (!(all > 0) || !(all < kInfinity)) {
                flight = {t, false, Rgb(0), 0};
                return false;
            }
            if (sampler.next_1d() * all < scattered) {
                flight = {t, true, weight * scattering * (all / (rate * scattered)), 1};
                return false;
            }
            if (!(passed > 0)) { // the random number was rounded
                flight = {t, false, Rgb(0), 0};
                return false;
            }
            weight *= null * (all / (rate * passed));
            if (!survives(weight, sampler)) {
                flight = {t, false, Rgb(0), 0};
                return false;
            }
        }
    });
    return flight;
}

Rgb BoundedMedia::estimate_emitted(const Ray &ray, float t_max, Sampler &sampler) const {
    const RayMedia &media = along(ray);
    Rgb weight(1), sum;
    for_each_interval(ray, t_max, [&](const MediumPiece &piece, float begin, float end, float majorant) {
        if (!piece.varies) {
            for (int c = 0; c < 3; ++c)
                if (piece.emission[c] > 0 && (piece.sigma_t[c] > 0 || end < kInfinity))
                    sum[c] += weight[c] * piece.emission[c] *
                              (piece.sigma_t[c] > 0 ? one_minus_exp(piece.sigma_t[c] * (end - begin)) / piece.sigma_t[c]
                                                    : end - begin);
            weight = attenuated(weight, piece.sigma_t, end - begin);
            return true;
        }
        const float length = std::min(std::min(piece.end, t_max) - piece.begin, 2 * bounds_radius_);
        const float rate = piece.shines && end < kInfinity ? std::max(majorant, kLooksAtEmission / length) : majorant;
        for (float t = begin;;) {
            const float step = rate > 0 ? exponential(sampler.next_bits()) / rate : kInfinity;
            if (!(t + step < end)) {
                weight = attenuated(weight, piece.sigma_t, end - t);
                return true;
            }
            t += step;
            weight = attenuated(weight, piece.sigma_t, step);
            const MediumPoint point = sum_at(media, piece, ray, t, rate);
            sum += weight * (piece.emission + point.emission) * (1 / rate);
            weight *= Rgb(1) - point.sigma_t() * (1 / rate);
            if (!survives(weight, sampler))
                return false;
        }
    });
    return sum;
}

ScatteringPoint BoundedMedia::varying_scattering_point(const RayMedia &media, const MediumPiece &piece, const Ray &ray,
                                                       float t, Sampler &sampler) const {
    struct Choice {
        Rgb sigma_s;
        float g;
    };
    thread_local std::vector<Choice> choices;
    choices.clear();
    Rgb total;
    for (uint32_t k = 0; k < piece.count; ++k) {
        const MediumPart &part = media.parts[piece.first + k];
        const InteriorMedium &m = media_[part.medium];
        Choice choice{m.coefficients.sigma_s, m.coefficients.g};
        if (m.varies) {
            const MediumPoint point = at(part, ray, t);
            choice = {point.sigma_s, point.g};
        }
        if (is_black(choice.sigma_s))
            continue;
        choices.push_back(choice);
        total += choice.sigma_s;
    }
    if (choices.empty())
        return {Rgb(0), {}};
    if (choices.size() == 1)
        return {Rgb(1), {choices[0].g}};
    float left = sampler.next_1d() * detail::sum(total);
    const Choice *chosen = nullptr;
    for (const Choice &choice : choices) {
        chosen = &choice; // the last one where rounding leaves a rest
        left -= detail::sum(choice.sigma_s);
        if (left < 0)
            break;
    }
    Rgb weight;
    for (int c = 0; c < 3; ++c)
        weight[c] = total[c] > 0 ? chosen->sigma_s[c] / total[c] : 0;
    return {weight * (detail::sum(total) / detail::sum(chosen->sigma_s)), {chosen->g}};
}

} // namespace glimmer
