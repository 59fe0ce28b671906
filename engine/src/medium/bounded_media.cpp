// SPDX-License-Identifier: GPL-3.0-or-later
#include "medium/bounded_media.h"

#include <algorithm>
#include <atomic>

namespace glimmer {

namespace {

/// How far the ray goes within a piece before t.
float length_before(const MediumPiece &p, float t) {
    return std::min(p.end, t) - p.begin;
}

Rgb depth_of(const Rgb &sigma, float length) {
    return detail::depths(sigma, length);
}

/// Sum over the pieces before t.
Rgb depth_along(const RayMedia &media, Rgb MediumPiece::*sigma, float t) {
    Rgb depth;
    for (const MediumPiece &p : media.pieces) {
        if (p.begin >= t)
            break;
        depth += depth_of(p.*sigma, length_before(p, t));
    }
    return depth;
}

const MediumPiece *piece_at(const RayMedia &media, float t) {
    for (const MediumPiece &p : media.pieces)
        if (t >= p.begin && t <= p.end)
            return &p;
    return nullptr;
}

bool scatters_before(const RayMedia &media, float t) {
    return std::ranges::any_of(media.pieces, [&](const MediumPiece &p) { return p.scatters && p.begin < t; });
}

/// Of a piece, by channel: the part of light that is scattered in it rather than absorbed, of what enters it.
Rgb scattered_in(const MediumPiece &p, float length) {
    Rgb part;
    for (int c = 0; c < 3; ++c)
        if (p.sigma_s[c] > 0)
            part[c] = p.sigma_s[c] / p.sigma_t[c] * one_minus_exp(p.sigma_t[c] * length);
    return part;
}

/// The same of all pieces before t, of what starts at the origin.
Rgb scattered_before(const RayMedia &media, float t) {
    Rgb depth, sum;
    for (const MediumPiece &p : media.pieces) {
        if (p.begin >= t)
            break;
        const float length = length_before(p, t);
        sum += exp_minus(depth) * scattered_in(p, length);
        depth += depth_of(p.sigma_t, length);
    }
    return sum;
}

Rgb quotient(const Rgb &a, const Rgb &b) {
    Rgb q;
    for (int c = 0; c < 3; ++c)
        q[c] = b[c] > 0 ? a[c] / b[c] : 0;
    return q;
}

} // namespace

BoundedMedia::BoundedMedia(std::shared_ptr<const Boundaries> boundaries, std::vector<uint32_t> bodies,
                           std::vector<InteriorMedium> media, uint32_t everywhere,
                           std::shared_ptr<const VaryingBodies> varying)
    : boundaries_(std::move(boundaries)), bodies_(std::move(bodies)), media_(std::move(media)), everywhere_(everywhere),
      varying_(std::move(varying)) {
    static std::atomic<uint64_t> count{0};
    number_ = ++count;
    float least = kInfinity;
    for (const InteriorMedium &m : media_) {
        emits_ |= !is_black(m.emission) || m.may_shine;
        scatters_ |= m.coefficients.scatters() || m.may_scatter;
        if (const float extinction = m.coefficients.least_scattering_extinction(); extinction < least) {
            least = extinction;
            thinnest_ = m.coefficients;
        }
    }
    g = thinnest_.g;
    convex_ = everywhere_ == kNone && boundaries_->is_one_convex_body();
    const Sphere bounds = boundaries_->bounds();
    bounds_center_ = Vec3f(bounds.center);
    bounds_radius_ = float(bounds.radius);
}

const RayMedia &BoundedMedia::along(const Ray &ray) const {
    struct Last {
        uint64_t number = 0;
        Vec3f origin, direction;
        ShutterTime time;
        RayMedia media;
    };
    // An estimator asks for one and the same ray several times: for its transmittance, for a point on it, for a
    // density.
    thread_local Last last;
    if (last.number != number_ || !(last.origin == ray.origin) || !(last.direction == ray.direction) ||
        last.time.value != ray.time.value) {
        last.number = number_;
        last.origin = ray.origin, last.direction = ray.direction, last.time = ray.time;
        find_pieces(ray, last.media);
    }
    return last.media;
}

void BoundedMedia::find_pieces(const Ray &ray, RayMedia &out) const {
    thread_local std::vector<Crossing> crossings;
    thread_local std::vector<int32_t> depth;     // by body: how often the ray is within it
    thread_local std::vector<uint32_t> touched;  // bodies that it meets
    thread_local std::vector<MediumPart> inside; // media that it is in
    boundaries_->cross(ray, crossings);
    depth.resize(std::max(depth.size(), bodies_.size()), 0);
    touched.clear(), inside.clear();
    out.pieces.clear(), out.parts.clear();
    if (everywhere_ != kNone)
        inside.push_back({everywhere_, kNone});
    for (const Crossing &c : crossings) {
        if (std::ranges::find(touched, c.body) == touched.end())
            touched.push_back(c.body);
        depth[c.body] += c.enters ? -1 : 1;
    }
    for (uint32_t body : touched) { // a body that the ray only enters is open: it starts outside
        depth[body] = std::max(depth[body], 0);
        if (depth[body] > 0)
            inside.push_back({bodies_[body], body});
    }
    float begin = 0;
    for (const Crossing &c : crossings) {
        const bool was_inside = depth[c.body] > 0;
        depth[c.body] += c.enters ? 1 : -1;
        const bool is_inside = depth[c.body] > 0;
        if (was_inside == is_inside)
            continue;
        add_piece(begin, c.t, inside, out);
        begin = c.t;
        if (is_inside)
            inside.push_back({bodies_[c.body], c.body});
        else // one of the medium is as good as another, unless it varies
            inside.erase(std::ranges::find_if(inside, [&](const MediumPart &p) {
                return p.medium == bodies_[c.body] && (p.body == c.body || !media_[p.medium].varies);
            }));
    }
    add_piece(begin, kInfinity, inside, out);
    for (uint32_t body : touched)
        depth[body] = 0;
}

void BoundedMedia::add_piece(float begin, float end, std::span<const MediumPart> inside, RayMedia &out) const {
    if (!(begin < end) || inside.empty())
        return;
    MediumPiece piece{begin, end,   {},   {}, {}, {}, uint32_t(out.parts.size()), uint32_t(inside.size()),
                      false, false, false};
    for (const MediumPart &part : inside) {
        const InteriorMedium &m = media_[part.medium];
        out.parts.push_back(part);
        if (m.varies) {
            piece.varies = true;
            piece.scatters |= m.may_scatter;
            piece.shines |= m.may_shine;
            continue;
        }
        piece.sigma_a += m.coefficients.sigma_a;
        piece.sigma_s += m.coefficients.sigma_s;
        piece.emission += m.emission;
    }
    piece.sigma_t = piece.sigma_a + piece.sigma_s;
    piece.scatters |= !is_black(piece.sigma_s);
    piece.shines |= !is_black(piece.emission);
    out.pieces.push_back(piece);
}

Rgb BoundedMedia::transmittance(const Ray &ray, float t) const {
    return exp_minus(depth_along(along(ray), &MediumPiece::sigma_t, t));
}

Rgb BoundedMedia::transmittance(const Ray &first, float t, const Ray &second, float t_second) const {
    const Rgb depth = depth_along(along(first), &MediumPiece::sigma_t, t);
    return exp_minus(depth + depth_along(along(second), &MediumPiece::sigma_t, t_second));
}

Rgb BoundedMedia::scattering(const Ray &ray, float t) const {
    const MediumPiece *piece = piece_at(along(ray), t);
    return piece ? piece->sigma_s : Rgb();
}

float BoundedMedia::least_absorbed(const Ray &ray, float t) const {
    const Rgb depth = depth_along(along(ray), &MediumPiece::sigma_a, t);
    return std::exp(-std::min(depth.r, std::min(depth.g, depth.b)));
}

Rgb BoundedMedia::emitted(const Ray &ray, float t) const {
    Rgb depth, sum;
    for (const MediumPiece &p : along(ray).pieces) {
        if (p.begin >= t)
            break;
        const float length = length_before(p, t);
        const Rgb left = exp_minus(depth);
        for (int c = 0; c < 3; ++c)
            if (p.emission[c] > 0 && left[c] > 0 && (p.sigma_t[c] > 0 || length < kInfinity)) // no end: an open mesh
                sum[c] += left[c] * p.emission[c] *
                          (p.sigma_t[c] > 0 ? one_minus_exp(p.sigma_t[c] * length) / p.sigma_t[c] : length);
        depth += depth_of(p.sigma_t, length);
    }
    return sum;
}

RayInterval BoundedMedia::scattering_range(const Ray &ray, float t) const {
    RayInterval range{t, 0};
    for (const MediumPiece &p : along(ray).pieces)
        if (p.scatters && p.begin < t) {
            range.begin = std::min(range.begin, p.begin);
            range.end = std::min(p.end, t);
        }
    return range;
}

ScatteringPoint BoundedMedia::scattering_point(const Ray &ray, float t, Sampler &sampler) const {
    const RayMedia &media = along(ray);
    const MediumPiece *piece = piece_at(media, t);
    if (!piece || !piece->scatters)
        return {Rgb(0), {}};
    if (piece->varies)
        return varying_scattering_point(media, *piece, ray, t, sampler);
    if (piece->count == 1)
        return {Rgb(1), {media_[media.parts[piece->first].medium].coefficients.g}};
    const float total = detail::sum(piece->sigma_s);
    float left = sampler.next_1d() * total;
    const HomogeneousMedium *chosen = nullptr;
    for (uint32_t k = 0; k < piece->count; ++k) {
        const HomogeneousMedium &m = media_[media.parts[piece->first + k].medium].coefficients;
        if (!m.scatters())
            continue;
        chosen = &m; // the last one where rounding leaves a rest
        left -= detail::sum(m.sigma_s);
        if (left < 0)
            break;
    }
    return {quotient(chosen->sigma_s, piece->sigma_s) * (total / detail::sum(chosen->sigma_s)), {chosen->g}};
}

FreeFlight sample_free_flight(const BoundedMedia &m, const Ray &ray, const Rgb &beta, float t_max, Sampler &sampler) {
    const RayMedia &media = m.along(ray);
    if (is_black(beta) || !scatters_before(media, t_max))
        return {t_max, false, m.transmittance(ray, t_max), 1};
    const Rgb share = beta / detail::sum(beta);
    const int channel = detail::pick_channel(share, sampler.next_1d());
    float left = exponential(sampler.next_bits()); // optical depth of scattering that the flight may still pass
    Rgb scattering, total, scale(1);               // depths up to the end; what the end itself counts
    float end = t_max;
    bool scattered = false;
    for (const MediumPiece &p : media.pieces) {
        if (p.begin >= t_max)
            break;
        const float length = length_before(p, t_max), sigma = p.sigma_s[channel];
        scattered = sigma > 0 && left < sigma * length;
        const float flown = scattered ? left / sigma : length;
        scattering += depth_of(p.sigma_s, flown);
        total += depth_of(p.sigma_t, flown);
        if (scattered) {
            end = p.begin + flown;
            scale = p.sigma_s;
            break;
        }
        left -= optical_depth(sigma, length);
    }
    const float offset = detail::least_depth(share, scale, scattering);
    if (!(offset < kInfinity) || (scattered && !(end < kInfinity)))
        return {end, scattered, Rgb(0), 0};
    const float p = detail::mixture(share, scale, scattering, offset);
    return {end, scattered, detail::weigh(beta, scale, total, offset, p), p * std::exp(-offset)};
}

float free_flight_pdf(const BoundedMedia &m, const Ray &ray, const Rgb &beta, float t) {
    const RayMedia &media = m.along(ray);
    const MediumPiece *piece = piece_at(media, t);
    if (!piece || is_black(beta))
        return 0;
    return detail::mixture(beta / detail::sum(beta), piece->sigma_s, depth_along(media, &MediumPiece::sigma_s, t), 0);
}

Collision sample_collision(const BoundedMedia &m, const Ray &ray, const Rgb &beta, float t_max, float u_channel,
                           uint64_t bits_t) {
    const RayMedia &media = m.along(ray);
    const Rgb scattered = scattered_before(media, t_max), share = beta * scattered;
    const float sum = detail::sum(share);
    if (!(sum > 0))
        return {0, Rgb(0), 0};
    const int channel = detail::pick_channel(share, u_channel);
    // The piece in which the channel's share of scattered light exceeds the random number, and the rest of that number.
    double left = (double(bits_t) + 0.5) * 0x1p-64 * double(scattered[channel]), in_piece = 0;
    const MediumPiece *piece = nullptr;
    Rgb depth, before;
    for (const MediumPiece &p : media.pieces) {
        if (p.begin >= t_max)
            break;
        const float length = length_before(p, t_max);
        const double part = double(exp_minus(depth)[channel] * scattered_in(p, length)[channel]);
        if (part > 0) {
            piece = &p, in_piece = part, before = depth;
            if (left < part)
                break;
            left -= part;
        }
        depth += depth_of(p.sigma_t, length);
    }
    if (!piece)
        return {0, Rgb(0), 0};
    const auto bits = uint64_t(std::min(left / in_piece, 1 - 0x1p-53) * 0x1p64);
    const float sigma = piece->sigma_t[channel], length = length_before(*piece, t_max);
    const float flown = std::min(truncated_exponential(bits, sigma * length) / sigma, length);
    if (!(flown < kInfinity))
        return {0, Rgb(0), 0};
    const Rgb at = before + depth_of(piece->sigma_t, flown), density = quotient(piece->sigma_s, scattered);
    const float offset = detail::least_depth(share, density, at);
    const float p = detail::mixture(share / sum, density, at, offset);
    return {piece->begin + flown, detail::weigh(beta, piece->sigma_s, at, offset, p), p * std::exp(-offset)};
}

float collision_pdf(const BoundedMedia &m, const Ray &ray, const Rgb &beta, float t_max, float t) {
    const RayMedia &media = m.along(ray);
    const MediumPiece *piece = piece_at(media, t);
    const Rgb scattered = scattered_before(media, t_max), share = beta * scattered;
    const float sum = detail::sum(share);
    if (!piece || !(sum > 0) || !(t >= 0 && t <= t_max))
        return 0;
    return detail::mixture(share / sum, quotient(piece->sigma_s, scattered),
                           depth_along(media, &MediumPiece::sigma_t, t), 0);
}

} // namespace glimmer
