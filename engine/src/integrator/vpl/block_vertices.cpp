// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/vpl/block_vertices.h"

#include "integrator/visibility.h"
#include "integrator/vpl/connect_simd.h"
#include "integrator/vpl/connection.h"
#include "integrator/vpl/tuning.h"
#include "medium/phase.h"

#include <array>
#include <cmath>

namespace glimmer {

namespace {

static_assert(tuning::kMediumPicks % kSimdLanes == 0, "a subset of picks fills whole registers");

VertexColumns columns(const MediumVertices &v, size_t first) {
    const auto from = [&](const std::vector<float> &column) { return column.data() + first; };
    if (!v.directed)
        return {from(v.x), from(v.y), from(v.z), from(v.r), from(v.g), from(v.b), nullptr, nullptr, nullptr};
    return {from(v.x), from(v.y), from(v.z), from(v.r), from(v.g), from(v.b), from(v.dx), from(v.dy), from(v.dz)};
}

/// Systematic resampling: draws `count` of the entries with one random number and calls pick(k, j, 1 / (p_j * count)),
/// k from 0. p_j is a defensive mixture of the targets and of the uniform distribution, so that no vertex has
/// probability 0 and none counts for many. (By power in place of uniform would spend picks far away, where the weight
/// window leaves few and heavy vertices.) Entries of power 0 bring nothing and are left out.
template <class Pick>
void resample(const std::vector<float> &targets, const std::vector<float> &powers, uint32_t count, float u,
              const Pick &pick) {
    double target_sum = 0;
    size_t bright = 0;
    for (size_t j = 0; j < targets.size(); ++j) {
        target_sum += double(targets[j]);
        bright += powers[j] > 0 ? 1 : 0;
    }
    if (bright == 0)
        return;
    const double by_target_share = target_sum > 1e-30 ? double(tuning::kPicksByTarget) : 0.0;
    const double by_target = by_target_share > 0 ? by_target_share / target_sum : 0.0,
                 uniform = (1 - by_target_share) / double(bright);
    double sum = 0;
    uint32_t k = 0;
    for (size_t j = 0; j < targets.size() && k < count; ++j) {
        const double p = powers[j] > 0 ? by_target * double(targets[j]) + uniform : 0.0;
        sum += p;
        // The last vertex takes the picks that rounding left over.
        for (; k < count && ((k + double(u)) < sum * count || (j + 1 == targets.size() && p > 0)); ++k)
            pick(k, j, float(1 / (p * count)));
    }
}

/// The vertex at which the parts, added up lane by lane, exceed `left`. Where rounding lets `left` outlast them all,
/// the last vertex that has a part.
size_t pick_medium_part(const float *parts, size_t count, const ConnectionSums &sums, float left) {
    size_t lane = 0, last_lane = 0;
    for (; lane < kSimdLanes && !(left < sums.by_lane[lane]); ++lane) {
        left -= sums.by_lane[lane];
        last_lane = sums.by_lane[lane] > 0 ? lane : last_lane;
    }
    if (lane == kSimdLanes)
        lane = last_lane, left = kInfinity;
    size_t last = lane;
    for (size_t k = lane; k < count; k += kSimdLanes) {
        if (parts[k] > 0)
            last = k;
        if (left < parts[k])
            return k;
        left -= parts[k];
    }
    return last;
}

} // namespace

BlockVertices::BlockVertices(const Scene &scene, const LightVertices &vertices, const VplSettings &settings,
                             const std::vector<Vec3f> &points, ShutterTime time, Sampler &sampler)
    : scene_(scene), settings_(settings), time_(time) {
    pick_medium(vertices.medium, points, sampler);
    pick_surface(vertices.surface, points, sampler);
    for (const VertexDepth &v : medium_.depth)
        deepest_ = {std::max(deepest_.depth, v.depth), std::max(deepest_.scatter, v.scatter)};
}

void BlockVertices::pick_medium(const MediumVertices &vertices, const std::vector<Vec3f> &points, Sampler &sampler) {
    const size_t n = vertices.size();
    const float u = sampler.next_1d();
    if (n == 0)
        return;
    medium_.directed = vertices.directed;
    medium_.counted = vertices.counted;
    medium_.grouped = vertices.grouped;
    std::vector<float> targets(n), powers(n);
    std::vector<GatherPoint> seen;
    seen.reserve(points.size());
    for (const Vec3f &q : points)
        seen.push_back({q.x, q.y, q.z, 0, 0, 0});
    // The vertices that do not fill a register keep a target of 0 and are drawn uniformly.
    connect_kernels().pick_targets(scene_.medium->simd_view(), columns(vertices, 0), n - n % kSimdLanes, seen.data(),
                                   seen.size(), tuning::kTargetClampFactor * settings_.medium_clamp_distance,
                                   targets.data());
    for (size_t j = 0; j < n; ++j) {
        powers[j] = mean_component(vertices.power(j));
        targets[j] *= powers[j];
    }
    const uint32_t count = settings_.subsets * uint32_t(tuning::kMediumPicks);
    std::vector<uint32_t> chosen(count);
    std::vector<float> scale(count, 0.0f);
    resample(targets, powers, count, u, [&](uint32_t k, size_t vertex, float factor) {
        chosen[k] = uint32_t(vertex);
        scale[k] = factor * float(settings_.subsets); // one subset alone stands for all
    });
    for (uint32_t s = 0; s < settings_.subsets; ++s)
        for (uint32_t k = s; k < count; k += settings_.subsets)
            medium_.add(vertices, chosen[k], scale[k]);
}

void BlockVertices::pick_surface(const std::vector<SurfaceVertex> &vertices, const std::vector<Vec3f> &points,
                                 Sampler &sampler) {
    const float u = sampler.next_1d();
    if (vertices.empty())
        return;
    const float sigma = scene_.medium->mean_extinction();
    const float clamp2 = tuning::kTargetClampFactor * tuning::kTargetClampFactor * settings_.surface_clamp_distance *
                         settings_.surface_clamp_distance;
    std::vector<float> targets(vertices.size()), powers(vertices.size());
    for (size_t j = 0; j < vertices.size(); ++j) {
        const SurfaceVertex &v = vertices[j];
        float near = 0;
        for (const Vec3f &q : points) {
            const Vec3f to_point = q - v.position;
            const float d2 = length_squared(to_point), d = std::sqrt(d2);
            const float cosine = dot(to_point, v.geometric) / std::max(d, 1e-30f);
            near += (std::max(v.both_sides ? std::abs(cosine) : cosine, 0.0f) + tuning::kTargetCosineFloor) *
                    std::exp(-sigma * d) / (d2 + clamp2);
        }
        powers[j] = v.reflected + tuning::kTargetPowerFloor * mean_component(v.power);
        targets[j] = near * powers[j];
    }
    const uint32_t count = settings_.subsets * uint32_t(tuning::kSurfacePicks);
    std::vector<SurfaceVertex> picked;
    picked.reserve(count);
    resample(targets, powers, count, u, [&](uint32_t, size_t vertex, float factor) {
        picked.push_back(vertices[vertex]);
        picked.back().power *= factor * float(settings_.subsets);
    });
    if (picked.size() < count)
        return;
    surface_.reserve(count);
    for (uint32_t s = 0; s < settings_.subsets; ++s)
        for (uint32_t k = s; k < count; k += settings_.subsets)
            surface_.push_back({picked[k], shade(picked[k])});
}

Bsdf BlockVertices::shade(const SurfaceVertex &v) {
    Interaction surface = scene_.interaction({v.position, -v.incoming, time_}, {0, v.instance, v.primitive, v.u, v.v});
    Bsdf bsdf = scene_.materials.shade(surface, {v.incoming, 0, time_, kFromDiffuse}, closures_).bsdf;
    bsdf.eta = v.eta;
    return bsdf;
}

struct BlockVertices::GatherQuery {
    Vec3f x, seen; ///< unit direction in which the camera looks
    uint32_t subset;
    float medium_clamp_distance, surface_clamp_distance;
};

/// The connections of a gather point to one subset. `parts` are means over the channels, 0 for what is not joined.
struct BlockVertices::Connections {
    Rgb total;
    float total_part = 0;
    size_t medium_count = 0, surface_count = 0;
    ConnectionSums medium_sums{};
    alignas(64) std::array<float, tuning::kMediumPicks> medium_parts;
    alignas(64) std::array<std::array<float, tuning::kMediumPicks>, 3> medium_values; ///< by channel, where grouped
    std::array<float, tuning::kSurfacePicks> surface_parts;
    std::array<Rgb, tuning::kSurfacePicks> surface_values;
};

Rgb BlockVertices::gather(const Vec3f &x, const Vec3f &seen, uint32_t subset, const DepthLimits &room, Sampler &sampler,
                          TraceContext &rays, LightGroups *groups) const {
    const float scale = settings_.clamp_distance_scale(scene_.camera.distance(x));
    const GatherQuery point{x, seen, subset, scale * settings_.medium_clamp_distance,
                            scale * settings_.surface_clamp_distance};
    Connections connections;
    if (medium_.size())
        connect_medium(point, room, connections);
    if (!surface_.empty())
        connect_surface(point, room, connections);
    Hidden hidden;
    if (connections.total_part > 0)
        hidden = estimate_hidden(point, connections, sampler.next_1d() * connections.total_part, rays);
    if (groups)
        add_by_group(point, connections, hidden, *groups);
    return connections.total - hidden.value;
}

void BlockVertices::connect_medium(const GatherQuery &point, const DepthLimits &room, Connections &connections) const {
    const size_t first = size_t(point.subset) * tuning::kMediumPicks;
    VertexColumns vertices = columns(medium_, first);
    alignas(64) std::array<std::array<float, tuning::kMediumPicks>, 3> power;
    if (!deepest_.fits(room)) { // vertices too deep take part with a power of 0
        for (size_t k = 0; k < tuning::kMediumPicks; ++k) {
            const bool fits = medium_.depth[first + k].fits(room);
            power[0][k] = fits ? vertices.r[k] : 0;
            power[1][k] = fits ? vertices.g[k] : 0;
            power[2][k] = fits ? vertices.b[k] : 0;
        }
        vertices.r = power[0].data(), vertices.g = power[1].data(), vertices.b = power[2].data();
    }
    const GatherPoint place{point.x.x, point.x.y, point.x.z, point.seen.x, point.seen.y, point.seen.z};
    auto &[r, g, b] = connections.medium_values;
    const ConnectionParts parts = medium_.grouped
                                      ? ConnectionParts{connections.medium_parts.data(), r.data(), g.data(), b.data()}
                                      : ConnectionParts{connections.medium_parts.data(), nullptr, nullptr, nullptr};
    const ConnectionSums sums = connect_kernels().connect(scene_.medium->simd_view(), vertices, tuning::kMediumPicks,
                                                          place, point.medium_clamp_distance, parts);
    connections.medium_count = tuning::kMediumPicks;
    connections.medium_sums = sums;
    connections.total = Rgb(sums.r, sums.g, sums.b);
    connections.total_part = sums.mean;
}

void BlockVertices::connect_surface(const GatherQuery &point, const DepthLimits &room, Connections &connections) const {
    const HenyeyGreenstein phase = scene_.medium->phase();
    const float d0 = point.surface_clamp_distance;
    const ShadedVertex *vertices = &surface_[size_t(point.subset) * tuning::kSurfacePicks];
    connections.surface_count = tuning::kSurfacePicks;
    for (size_t k = 0; k < tuning::kSurfacePicks; ++k) {
        const SurfaceVertex &v = vertices[k].vertex;
        const Vec3f to_point = point.x - v.position;
        connections.surface_parts[k] = 0;
        if ((!(dot(to_point, v.geometric) > 0) && !v.both_sides) || !v.depth.fits(room))
            continue;
        const float d2 = length_squared(to_point), d = std::sqrt(d2);
        const Connection c = connect(v, vertices[k].bsdf, to_point / d);
        const float scale = c.bounded * phase.eval(point.seen, -to_point / d) / (d2 + d0 * d0);
        const Rgb value =
            c.factor * v.power * scene_.medium->transmittance({v.position, to_point / d, time_}, d) * scale;
        connections.surface_values[k] = value;
        connections.surface_parts[k] = mean_component(value);
        connections.total += value;
        connections.total_part += connections.surface_parts[k];
    }
}

BlockVertices::Hidden BlockVertices::estimate_hidden(const GatherQuery &point, const Connections &connections,
                                                     float left, TraceContext &rays) const {
    // The sum took every vertex for visible (docs/method.md, section 4).
    for (size_t k = 0; k < connections.surface_count; ++k) {
        const float part = connections.surface_parts[k];
        if (part > 0 && left < part) {
            const SurfaceVertex &v = surface_[size_t(point.subset) * tuning::kSurfacePicks + k].vertex;
            const float side = std::copysign(v.error, dot(point.x - v.position, v.geometric));
            const Vec3f from = v.position + v.geometric * side, way = point.x - from;
            const float d = length(way);
            return {hidden(connections, connections.surface_values[k], part, {from, way / d, time_, d}, rays), v.group};
        }
        left -= part;
    }
    return connections.medium_count ? estimate_hidden_medium(point, connections, left, rays) : Hidden{};
}

BlockVertices::Hidden BlockVertices::estimate_hidden_medium(const GatherQuery &point, const Connections &connections,
                                                            float left, TraceContext &rays) const {
    const size_t k =
        pick_medium_part(connections.medium_parts.data(), connections.medium_count, connections.medium_sums, left);
    const float part = connections.medium_parts[k];
    if (!(part > 0)) // rounding let `left` outlast the surface's parts, and the medium has none
        return {};
    const size_t j = size_t(point.subset) * tuning::kMediumPicks + k;
    const Vec3f way = medium_.position(j) - point.x;
    const float d = length(way), d0 = point.medium_clamp_distance;
    const HenyeyGreenstein phase = scene_.medium->phase();
    const float phases = medium_.directed ? phase.eval(point.seen, way / d) * phase.eval(medium_.direction(j), -way / d)
                                          : kIsotropicPhase * kIsotropicPhase;
    const Rgb value =
        medium_.power(j) * scene_.medium->transmittance({point.x, way / d, time_}, d) * (phases / (d * d + d0 * d0));
    return {hidden(connections, value, part, {point.x, way / d, time_, d}, rays),
            medium_.grouped ? medium_.group[j] : uint8_t(0)};
}

Rgb BlockVertices::hidden(const Connections &connections, const Rgb &value, float part, const Ray &ray,
                          TraceContext &rays) const {
    const Rgb arriving = ray.t_max > 0 ? visibility(scene_, ray, RayKind::volume, rays) : Rgb(1);
    return arriving == Rgb(1) ? Rgb() : value * (Rgb(1) - arriving) * (connections.total_part / part);
}

void BlockVertices::add_by_group(const GatherQuery &point, const Connections &connections, const Hidden &hidden,
                                 LightGroups &groups) const {
    const auto add = [&](uint8_t group, const Rgb &value) {
        if (group)
            groups[group - 1u] += value;
    };
    const auto &[r, g, b] = connections.medium_values;
    for (size_t k = 0; k < connections.medium_count; ++k)
        add(medium_.group[size_t(point.subset) * tuning::kMediumPicks + k], {r[k], g[k], b[k]});
    for (size_t k = 0; k < connections.surface_count; ++k)
        if (connections.surface_parts[k] > 0)
            add(surface_[size_t(point.subset) * tuning::kSurfacePicks + k].vertex.group, connections.surface_values[k]);
    add(hidden.group, hidden.value * -1);
}

} // namespace glimmer
