// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/vertex_pool.h"

#include "math/simd.h"
#include "medium/phase.h"

#include <array>
#include <cmath>

namespace glimmer {

namespace {

// Of the picks by target, the rest by number: no vertex has probability 0, and none counts for many. (By power would
// spend them far away, where the weight window leaves few and heavy vertices.)
constexpr float kGuided = 0.7f;
constexpr float kSoften = 3; // targets see bounds this much larger, for points that the representatives are not
constexpr uint32_t kMostPicks = 512;

/// The Henyey-Greenstein phase function, eight cosines between directions of propagation at a time.
class Phase8 {
  public:
    explicit Phase8(float g) : constant_(1 + g * g), slope_(2 * g), scale_((1 - g) * (1 + g) * kIsotropicPhase) {}
    Float8 operator()(Float8 cosine) const {
        const Float8 d2 = max(constant_ - slope_ * cosine, Float8(1e-12f));
        return scale_ / (d2 * sqrt(d2));
    }

  private:
    Float8 constant_, slope_, scale_;
};

float mean_extinction(const Homogeneous &medium) {
    return (medium.sigma_t.r + medium.sigma_t.g + medium.sigma_t.b) / 3;
}

/// One systematic draw of `count` of the entries by targets: calls pick(k, j, 1 / (p_j * count)) with k from 0. Entries
/// of power 0 bring nothing and are left out.
template <class Pick>
void draw(const std::vector<float> &targets, const std::vector<float> &powers, uint32_t count, float u,
          const Pick &pick) {
    double target_sum = 0;
    size_t bright = 0;
    for (size_t j = 0; j < targets.size(); ++j) {
        target_sum += double(targets[j]);
        bright += powers[j] > 0 ? 1 : 0;
    }
    if (bright == 0)
        return;
    const double guided = target_sum > 1e-30 ? double(kGuided) : 0.0;
    const double by_target = guided > 0 ? guided / target_sum : 0.0, by_number = (1 - guided) / double(bright);
    double sum = 0;
    uint32_t k = 0;
    for (size_t j = 0; j < targets.size() && k < count; ++j) {
        const double p = powers[j] > 0 ? by_target * double(targets[j]) + by_number : 0.0;
        sum += p;
        // The last vertex takes what rounding left over.
        for (; k < count && ((k + double(u)) < sum * count || (j + 1 == targets.size() && p > 0)); ++k)
            pick(k, j, float(1 / (p * count)));
    }
}

} // namespace

VertexPool::VertexPool(const Scene &scene, const LightVertices &vertices, const PoolSettings &settings,
                       const std::vector<Vec3f> &points, Sampler &sampler)
    : scene_(scene), settings_(settings) {
    pick_fog(vertices.fog, points, sampler);
    pick_surface(vertices.surface, points, sampler);
}

void VertexPool::pick_fog(const FogVertices &vertices, const std::vector<Vec3f> &points, Sampler &sampler) {
    const size_t n = vertices.size();
    const float u = sampler.next_1d();
    if (n == 0)
        return;
    std::vector<float> targets(n + 8), powers(n);
    const Float8 sigma(-mean_extinction(*scene_.medium)),
        soften(kSoften * kSoften * settings_.fog_bound * settings_.fog_bound);
    const bool even = !vertices.directed;
    fog_.directed = vertices.directed;
    const Phase8 phase(scene_.medium->g);
    size_t j = 0;
    for (; j + 8 <= n; j += 8) {
        const Float8 x = Float8::load(&vertices.x[j]), y = Float8::load(&vertices.y[j]),
                     z = Float8::load(&vertices.z[j]);
        Float8 near;
        for (const Vec3f &q : points) {
            const Float8 dx = x - Float8(q.x), dy = y - Float8(q.y), dz = z - Float8(q.z);
            const Float8 d2 = dx * dx + dy * dy + dz * dz, d = sqrt(d2);
            Float8 value = exp(sigma * d) / (d2 + soften);
            if (!even) {
                const Float8 along = Float8::load(&vertices.dx[j]) * dx + Float8::load(&vertices.dy[j]) * dy +
                                     Float8::load(&vertices.dz[j]) * dz;
                value = value * phase(Float8() - along / max(d, Float8(1e-30f)));
            }
            near = near + value;
        }
        near.store(&targets[j]);
    }
    for (; j < n; ++j) // the last few are drawn by number alone
        targets[j] = 0;
    for (j = 0; j < n; ++j) {
        powers[j] = mean_component(vertices.power(j));
        targets[j] *= powers[j];
    }
    targets.resize(n);
    const uint32_t count = settings_.sub_pools * settings_.fog_picks;
    std::vector<uint32_t> chosen(count);
    std::vector<float> scale(count, 0.0f);
    draw(targets, powers, count, u, [&](uint32_t k, size_t vertex, float factor) {
        chosen[k] = uint32_t(vertex);
        scale[k] = factor * float(settings_.sub_pools); // one sub-pool alone stands for all
    });
    for (uint32_t s = 0; s < settings_.sub_pools; ++s)
        for (uint32_t k = s; k < count; k += settings_.sub_pools)
            fog_.add(vertices, chosen[k], scale[k]);
}

void VertexPool::pick_surface(const std::vector<SurfaceVertex> &vertices, const std::vector<Vec3f> &points,
                              Sampler &sampler) {
    const float u = sampler.next_1d();
    if (vertices.empty())
        return;
    const float sigma = mean_extinction(*scene_.medium);
    const float soften = kSoften * kSoften * settings_.surface_bound * settings_.surface_bound;
    std::vector<float> targets(vertices.size()), powers(vertices.size());
    for (size_t j = 0; j < vertices.size(); ++j) {
        const SurfaceVertex &v = vertices[j];
        float near = 0;
        for (const Vec3f &q : points) {
            const Vec3f to_point = q - v.position;
            const float d2 = length_squared(to_point), d = std::sqrt(d2);
            near += (std::max(dot(to_point, v.geometric) / std::max(d, 1e-30f), 0.0f) + 0.01f) * std::exp(-sigma * d) /
                    (d2 + soften);
        }
        powers[j] = v.reflectance + 1e-6f * mean_component(v.power);
        targets[j] = near * powers[j];
    }
    const uint32_t count = settings_.sub_pools * settings_.surface_picks;
    std::vector<SurfaceVertex> picked;
    picked.reserve(count);
    draw(targets, powers, count, u, [&](uint32_t, size_t vertex, float factor) {
        picked.push_back(vertices[vertex]);
        picked.back().power *= factor * float(settings_.sub_pools);
    });
    if (picked.size() < count)
        return;
    surface_.reserve(count);
    for (uint32_t s = 0; s < settings_.sub_pools; ++s)
        for (uint32_t k = s; k < count; k += settings_.sub_pools)
            surface_.push_back(picked[k]);
}

Rgb VertexPool::gather(const Vec3f &x, const Vec3f &seen, Sampler &sampler, RayCounter &rays) const {
    const Homogeneous &medium = *scene_.medium;
    const HenyeyGreenstein phase{medium.g};
    const bool even = !fog_.directed;
    const uint32_t sub_pool =
        std::min(uint32_t(sampler.next_1d() * float(settings_.sub_pools)), settings_.sub_pools - 1);
    alignas(32) std::array<float, kMostPicks> fog_parts;
    std::array<float, kMostPicks> surface_parts;
    std::array<Rgb, kMostPicks> surface_values;
    Rgb total;
    float parts = 0;

    const size_t fog_count = fog_.size() ? settings_.fog_picks : 0, fog_first = size_t(sub_pool) * settings_.fog_picks;
    if (fog_count) {
        const Float8 px(x.x), py(x.y), pz(x.z), bound(settings_.fog_bound * settings_.fog_bound);
        const Float8 sr(-medium.sigma_t.r), sg(-medium.sigma_t.g), sb(-medium.sigma_t.b);
        const Float8 third(1 / 3.0f);
        const Float8 sx(seen.x), sy(seen.y), sz(seen.z);
        const Phase8 phases(medium.g);
        Float8 red, green, blue, part_sum;
        for (size_t k = 0; k < fog_count; k += 8) {
            const size_t j = fog_first + k;
            const Float8 dx = Float8::load(&fog_.x[j]) - px, dy = Float8::load(&fog_.y[j]) - py,
                         dz = Float8::load(&fog_.z[j]) - pz;
            const Float8 d2 = dx * dx + dy * dy + dz * dz, d = sqrt(d2);
            Float8 inverse = Float8(kIsotropicPhase * kIsotropicPhase) / (d2 + bound);
            if (!even) {
                const Float8 to_vertex = Float8(1.0f) / max(d, Float8(1e-30f));
                const Float8 here = (dx * sx + dy * sy + dz * sz) * to_vertex;
                const Float8 there =
                    (dx * Float8::load(&fog_.dx[j]) + dy * Float8::load(&fog_.dy[j]) + dz * Float8::load(&fog_.dz[j])) *
                    to_vertex;
                inverse = phases(here) * phases(Float8() - there) / (d2 + bound);
            }
            const Float8 er = exp(sr * d) * inverse;
            const Float8 r = er * Float8::load(&fog_.r[j]);
            const Float8 g = (medium.grey ? er : exp(sg * d) * inverse) * Float8::load(&fog_.g[j]);
            const Float8 b = (medium.grey ? er : exp(sb * d) * inverse) * Float8::load(&fog_.b[j]);
            const Float8 part = (r + g + b) * third; // mean_component
            part.store(&fog_parts[k]);
            red = red + r, green = green + g, blue = blue + b, part_sum = part_sum + part;
        }
        total = Rgb(sum(red), sum(green), sum(blue));
        parts = sum(part_sum);
    }
    const size_t surface_count = surface_.empty() ? 0 : settings_.surface_picks;
    const SurfaceVertex *surface = surface_.data() + size_t(sub_pool) * settings_.surface_picks;
    for (size_t k = 0; k < surface_count; ++k) {
        const SurfaceVertex &v = surface[k];
        const Vec3f to_point = x - v.position;
        surface_parts[k] = 0;
        if (!(dot(to_point, v.geometric) > 0))
            continue;
        const float d2 = length_squared(to_point), d = std::sqrt(d2);
        const Connection c = connect(v, scene_.bsdf(scene_.materials[v.material]), to_point / d);
        const float scale =
            c.held * phase.eval(seen, -to_point / d) / (d2 + settings_.surface_bound * settings_.surface_bound);
        surface_values[k] = c.factor * v.power * medium.transmittance(d) * scale;
        surface_parts[k] = mean_component(surface_values[k]);
        total += surface_values[k];
        parts += surface_parts[k];
    }
    if (!(parts > 0))
        return total;

    // Visibility by one shadow ray: the sum as if all were seen, corrected by one vertex.
    float left = sampler.next_1d() * parts;
    ++rays.rays;
    for (size_t k = 0; k < surface_count; ++k) {
        if (surface_parts[k] > 0 && left < surface_parts[k]) {
            const SurfaceVertex &v = surface[k];
            const Vec3f from = v.position + v.geometric * v.error, way = x - from;
            const float d = length(way);
            const bool hidden = d > 0 && scene_.accel->occluded({from, way / d, d});
            return hidden ? total - surface_values[k] * (parts / surface_parts[k]) : total;
        }
        left -= surface_parts[k];
    }
    size_t k = 0, last = 0;
    for (; k < fog_count; ++k) {
        if (fog_parts[k] > 0)
            last = k;
        if (fog_parts[k] > 0 && left < fog_parts[k])
            break;
        left -= fog_parts[k];
    }
    if (fog_count == 0)
        return total;
    k = std::min(k, last); // rounding may let the number outlast the sum
    const size_t j = fog_first + k;
    const Vec3f way = fog_.position(j) - x;
    const float d = length(way);
    if (!(d > 0) || !scene_.accel->occluded({x, way / d, d}))
        return total;
    const float phases =
        even ? kIsotropicPhase * kIsotropicPhase : phase.eval(seen, way / d) * phase.eval(fog_.direction(j), -way / d);
    const Rgb value =
        fog_.power(j) * medium.transmittance(d) * (phases / (d * d + settings_.fog_bound * settings_.fog_bound));
    return total - value * (parts / fog_parts[k]);
}

} // namespace glimmer
