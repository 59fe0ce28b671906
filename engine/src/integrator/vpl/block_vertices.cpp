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
                             const std::vector<Vec3f> &points, Sampler &sampler)
    : scene_(scene), settings_(settings) {
    pick_medium(vertices.medium, points, sampler);
    pick_surface(vertices.surface, points, sampler);
}

void BlockVertices::pick_medium(const MediumVertices &vertices, const std::vector<Vec3f> &points, Sampler &sampler) {
    const size_t n = vertices.size();
    const float u = sampler.next_1d();
    if (n == 0)
        return;
    medium_.directed = vertices.directed;
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
            const float cosine = std::max(dot(to_point, v.geometric) / std::max(d, 1e-30f), 0.0f);
            near += (cosine + tuning::kTargetCosineFloor) * std::exp(-sigma * d) / (d2 + clamp2);
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
    Interaction surface = scene_.interaction({v.position, -v.incoming}, {0, v.instance, v.primitive, v.u, v.v});
    return scene_.materials.shade(surface, {v.incoming}, closures_).bsdf;
}

Rgb BlockVertices::gather(const Vec3f &x, const Vec3f &seen, Sampler &sampler, TraceContext &rays) const {
    const Medium &medium = *scene_.medium;
    const HenyeyGreenstein phase = medium.phase();
    const bool isotropic = !medium_.directed;
    const uint32_t subset = std::min(uint32_t(sampler.next_1d() * float(settings_.subsets)), settings_.subsets - 1);
    alignas(64) std::array<float, tuning::kMediumPicks> medium_parts;
    std::array<float, tuning::kSurfacePicks> surface_parts;
    std::array<Rgb, tuning::kSurfacePicks> surface_values;
    const float clamp_distance_scale = settings_.clamp_distance_scale(scene_.camera.distance(x));
    const float medium_clamp_distance = clamp_distance_scale * settings_.medium_clamp_distance,
                surface_clamp_distance = clamp_distance_scale * settings_.surface_clamp_distance;
    Rgb total;
    float parts = 0;

    const size_t medium_count = medium_.size() ? tuning::kMediumPicks : 0,
                 medium_first = size_t(subset) * tuning::kMediumPicks;
    ConnectionSums medium_sums{};
    if (medium_count) {
        const GatherPoint point{x.x, x.y, x.z, seen.x, seen.y, seen.z};
        medium_sums = connect_kernels().connect(medium.simd_view(), columns(medium_, medium_first), medium_count, point,
                                                medium_clamp_distance, medium_parts.data());
        total = Rgb(medium_sums.r, medium_sums.g, medium_sums.b);
        parts = medium_sums.mean;
    }
    const size_t surface_count = surface_.empty() ? 0 : tuning::kSurfacePicks;
    const ShadedVertex *surface = surface_count ? &surface_[size_t(subset) * tuning::kSurfacePicks] : nullptr;
    for (size_t k = 0; k < surface_count; ++k) {
        const SurfaceVertex &v = surface[k].vertex;
        const Vec3f to_point = x - v.position;
        surface_parts[k] = 0;
        if (!(dot(to_point, v.geometric) > 0))
            continue;
        const float d2 = length_squared(to_point), d = std::sqrt(d2);
        const Connection c = connect(v, surface[k].bsdf, to_point / d);
        const float scale =
            c.bounded * phase.eval(seen, -to_point / d) / (d2 + surface_clamp_distance * surface_clamp_distance);
        surface_values[k] = c.factor * v.power * medium.transmittance({v.position, to_point / d}, d) * scale;
        surface_parts[k] = mean_component(surface_values[k]);
        total += surface_values[k];
        parts += surface_parts[k];
    }
    if (!(parts > 0))
        return total;

    // One shadow ray corrects the sum, which took every vertex for visible (docs/method.md, section 4).
    const auto corrected = [&](const Rgb &value, float part, const Ray &ray) {
        const Rgb arriving = ray.t_max > 0 ? visibility(scene_, ray, rays) : Rgb(1);
        return arriving == Rgb(1) ? total : total - value * (Rgb(1) - arriving) * (parts / part);
    };
    float left = sampler.next_1d() * parts;
    for (size_t k = 0; k < surface_count; ++k) {
        if (surface_parts[k] > 0 && left < surface_parts[k]) {
            const SurfaceVertex &v = surface[k].vertex;
            const Vec3f from = v.position + v.geometric * v.error, way = x - from;
            const float d = length(way);
            return corrected(surface_values[k], surface_parts[k], {from, way / d, d});
        }
        left -= surface_parts[k];
    }
    if (medium_count == 0)
        return total;
    const size_t k = pick_medium_part(medium_parts.data(), medium_count, medium_sums, left);
    if (!(medium_parts[k] > 0)) // rounding let `left` outlast the surface's parts, and the medium has none
        return total;
    const size_t j = medium_first + k;
    const Vec3f way = medium_.position(j) - x;
    const float d = length(way);
    const float phases = isotropic ? kIsotropicPhase * kIsotropicPhase
                                   : phase.eval(seen, way / d) * phase.eval(medium_.direction(j), -way / d);
    const Rgb value = medium_.power(j) * medium.transmittance({x, way / d}, d) *
                      (phases / (d * d + medium_clamp_distance * medium_clamp_distance));
    return corrected(value, medium_parts[k], {x, way / d, d});
}

} // namespace glimmer
