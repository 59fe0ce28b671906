// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/vpl/light_vertex_cache.h"

#include "integrator/return_bound.h"
#include "medium/phase.h"

#include <algorithm>
#include <cmath>

namespace glimmer {

namespace {

// Where surfaces scatter too, much of the error is theirs: 3 gathers give 1.05 of the variance of 4 at equal cost in
// the clearing and in thick medium, 6 in thick medium .99. In medium alone 8 give .78 of it, and 12 .80.
constexpr uint32_t kGathers = 4, kGathersInMediumAlone = 8;
constexpr uint32_t kImportancePoints = 32; // seen points that steer the light paths
constexpr uint32_t kBlockPoints = 12;      // seen points that stand for a block
// Light paths cost about a tenth of the camera's work then. In medium alone they are short, and twice as many halve the
// error of what all pixels share.
constexpr uint32_t kPixelsPerPath = 6, kPixelsPerPathInMediumAlone = 3;
constexpr uint32_t kMostPaths = 24576; // every block looks at all their vertices: beyond, that is what takes the time
constexpr uint32_t kMostVertices = 1u << 18; // of a pass, about: for the same reason, and for memory
// Of the median distance of what is seen: nearer the camera, beams are few and bright.
constexpr float kSplatBound = 0.03f;
constexpr float kDense = 50, kDiffuse = 5; // radii of the scene in mean free paths, and in lengths of diffusion
constexpr float kMostForward = 0.9f, kMostBackward = -0.6f; // beyond, peaks that meet outweigh what vertices save
constexpr uint64_t kPassStream = 0x9a55, kBlockStream = 0xb10c,
                   kPilotStream = 0x9107; // keep the streams of random numbers apart

struct LightVertexWave final : WaveData {
    size_t bytes() const override {
        return (vertices.medium.x.capacity() * 6 + vertices.medium.dx.capacity() * 3) * sizeof(float) +
               vertices.surface.capacity() * sizeof(SurfaceVertex) + vertices.splats.capacity() * sizeof(Splat);
    }
    uint64_t seed, sample;
    LightVertices vertices;
};

Sampler stream(uint64_t kind, uint64_t seed, uint64_t sample, uint32_t x, uint32_t y) {
    return {hash64(seed, kind), x, y, uint32_t(sample >> 32), uint32_t(sample)};
}

} // namespace

LightVertexCache::LightVertexCache(const Scene &scene, const InteriorStack &around_camera)
    : scene_(scene), around_camera_(around_camera) {
    const FilmSettings &film = scene.film;
    const uint32_t pixels = film.crop_width * film.crop_height;
    settings_.paths =
        std::clamp(pixels / (scene.has_surfaces ? kPixelsPerPath : kPixelsPerPathInMediumAlone), 512u, kMostPaths);
    settings_.gathers = scene.has_surfaces ? kGathers : kGathersInMediumAlone;
    set_bounds();
}

/// d0 from a pilot pass: d0^2 = sigma / (4 pi density), at which a vertex that near brings about as much as all the
/// light of its neighbourhood; the error is flat about it. The density is that of the vertices around points that the
/// camera sees; farther away than these, d0 grows (VplSettings::widening).
void LightVertexCache::set_bounds() {
    constexpr uint32_t kPoints = 64, kNeighbours = 8;
    TraceContext rays;
    Sampler sampler = stream(kPilotStream, 0, 0, 0, 0);
    const FilmSettings &film = scene_.film;
    const Rectangle all{film.crop_x, film.crop_y, film.crop_width, film.crop_height};
    const std::vector<Vec3f> points = visible_points(all, kPoints, sampler, rays);
    VplSettings pilot_settings = settings_;
    pilot_settings.paths = std::min(settings_.paths, 2048u);
    const ImportanceMap importance(scene_, visible_points(all, kImportancePoints, sampler, rays));
    const std::atomic<bool> never{false};
    const LightVertices pilot = trace_light_subpaths(scene_, importance, pilot_settings, sampler, never, rays);
    const size_t vertices = std::max(pilot.medium.size(), pilot.surface.size());
    if (vertices > kMostVertices / settings_.paths * pilot_settings.paths)
        settings_.paths = std::max(uint32_t(uint64_t(kMostVertices) * pilot_settings.paths / vertices), 64u);
    const float sigma = max_component(scene_.medium->sigma_t);
    std::vector<float> densities;
    for (const Vec3f &q : points) {
        std::vector<float> d2;
        for (size_t j = 0; j < pilot.medium.size(); ++j)
            d2.push_back(length_squared(pilot.medium.position(j) - q));
        if (d2.size() < kNeighbours)
            continue;
        std::nth_element(d2.begin(), d2.begin() + kNeighbours - 1, d2.end());
        const float r = std::sqrt(d2[kNeighbours - 1]);
        densities.push_back(kNeighbours / (4.0f / 3 * kPi * r * r * r));
    }
    float bound = 0.1f / sigma; // hardly any vertices: what is left for the pool is little
    if (!densities.empty()) {
        std::nth_element(densities.begin(), densities.begin() + long(densities.size() / 2), densities.end());
        const float density = densities[densities.size() / 2] * float(settings_.paths) / float(pilot_settings.paths);
        bound = std::min(std::sqrt(sigma / (4 * kPi * density)), 1 / sigma);
    }
    // Two peaks of a phase function that meet are rarer and brighter: d0^2 grows as the root of the peak.
    bound *= std::pow(HenyeyGreenstein{scene_.medium->g}.peak() / kIsotropicPhase, 0.25f);
    settings_.medium_clamp_distance = bound;
    settings_.surface_clamp_distance = 2 * bound;
    std::vector<float> distances;
    for (const Vec3f &q : points)
        distances.push_back(scene_.camera.distance(q));
    if (!distances.empty()) {
        std::nth_element(distances.begin(), distances.begin() + long(distances.size() / 2), distances.end());
        settings_.median_distance = distances[distances.size() / 2];
        settings_.splat_clamp_distance = kSplatBound * scene_.camera.footprint(settings_.median_distance);
    }
    settings_.effective_attenuation = effective_attenuation(*scene_.medium);
}

std::vector<Vec3f> LightVertexCache::visible_points(const Rectangle &pixels, uint32_t count, Sampler &sampler,
                                                    TraceContext &rays) const {
    return sample_visible_points(scene_, pixels, around_camera_, count, sampler, rays);
}

std::unique_ptr<const WaveData> LightVertexCache::prepare_wave(uint64_t seed, uint64_t sample,
                                                               const std::atomic<bool> &stop,
                                                               TraceContext &rays) const {
    auto pass = std::make_unique<LightVertexWave>();
    pass->seed = seed;
    pass->sample = sample;
    Sampler sampler = stream(kPassStream, seed, sample, 0, 0);
    const FilmSettings &film = scene_.film;
    const ImportanceMap importance(scene_, visible_points({film.crop_x, film.crop_y, film.crop_width, film.crop_height},
                                                          kImportancePoints, sampler, rays));
    pass->vertices = trace_light_subpaths(scene_, importance, settings_, sampler, stop, rays);
    return pass;
}

std::unique_ptr<const BlockData> LightVertexCache::prepare_block(const WaveData &data, const Rectangle &block,
                                                                 TraceContext &rays) const {
    const auto &pass = static_cast<const LightVertexWave &>(data);
    Sampler sampler = stream(kBlockStream, pass.seed, pass.sample, block.x, block.y);
    const std::vector<Vec3f> points = visible_points(block, kBlockPoints, sampler, rays);
    auto shared = std::make_unique<LightVertexBlock>(
        settings_, BlockVertices(scene_, pass.vertices, settings_, points, sampler), block);
    for (const Splat &s : pass.vertices.splats)
        if (s.x - block.x < block.width && s.y - block.y < block.height) // unsigned: not before it either
            shared->splats[size_t(s.y - block.y) * block.width + (s.x - block.x)] += s.radiance;
    shared->unfinished = pass.vertices.unfinished;
    return shared;
}

std::unique_ptr<const LightVertexCache> plan_light_vertex_cache(const Scene &scene, const DepthLimits &limits,
                                                                const InteriorStack &around_camera) {
    const DepthLimits none;
    if (!scene.medium || !scene.medium->scatters() || scene.medium->g > kMostForward ||
        scene.medium->g < kMostBackward || !around_camera.empty() || limits.depth != none.depth ||
        limits.scatter != none.scatter)
        return nullptr;
    if (scene.bounds_radius * max_component(scene.medium->sigma_t) > kDense &&
        scene.bounds_radius * effective_attenuation(*scene.medium) < kDiffuse)
        return nullptr;
    for (uint32_t i = 0; i < scene.lights.size(); ++i)
        if (!scene.lights.bound(i).infinite)
            return std::make_unique<LightVertexCache>(scene, around_camera);
    return nullptr;
}

} // namespace glimmer
