// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/vpl/light_vertex_cache.h"

#include "integrator/shutter.h"
#include "integrator/vpl/gather_points.h"
#include "integrator/vpl/importance_map.h"
#include "integrator/vpl/light_subpaths.h"
#include "integrator/vpl/spatial_order.h"
#include "integrator/vpl/streams.h"
#include "integrator/vpl/tuning.h"

namespace glimmer {

namespace {

struct LightVertexWave final : WaveData {
    size_t bytes() const override {
        return (vertices.medium.x.capacity() * 6 + vertices.medium.dx.capacity() * 3) * sizeof(float) +
               vertices.medium.depth.capacity() * sizeof(VertexDepth) + vertices.medium.group.capacity() +
               vertices.surface.capacity() * sizeof(SurfaceVertex) + vertices.splats.capacity() * sizeof(Splat);
    }
    uint64_t seed, sample;
    ShutterTime time; ///< of all of its rays
    LightVertices vertices;
};

bool has_narrow_peak(const HenyeyGreenstein &phase) {
    return phase.g > tuning::kMostForwardG || phase.g < tuning::kMostBackwardG;
}

bool is_dense_and_white(const Scene &scene) {
    const BoundedMedia *bounded = scene.medium->bounded();
    const float radius = bounded ? bounded->bounds_radius() : scene.bounds_radius;
    return radius * scene.medium->majorant() > tuning::kDenseRadius &&
           radius * scene.medium->effective_attenuation() < tuning::kDiffuseRadius;
}

/// Whether a subpath can start anywhere: light from infinity has no way into a medium without end.
bool has_light_to_start_at(const Scene &scene) {
    for (uint32_t i = 0; i < scene.lights.size(); ++i)
        if (!scene.lights.bound(i).infinite || scene.medium->bounded())
            return true;
    return false;
}

/// Why media within surfaces would not be served; null where they are.
const char *reason_against(const BoundedMedia &media) {
    if (media.varies())
        return "there is fog that varies from place to place";
    if (!media.is_one_convex_body())
        return "there is fog within surfaces that is not one convex body";
    if (media.emits())
        return "there is fog that shines";
    return nullptr;
}

/// Why the cache would not serve a medium that scatters; null where it does.
const char *reason_against(const Scene &scene, const DepthLimits &limits, const InteriorStack &around_camera) {
    if (const BoundedMedia *bounded = scene.medium->bounded())
        if (const char *reason = reason_against(*bounded))
            return reason;
    if (scene.medium->height_haze())
        return "the fog thins out with height";
    if (limits.depth < 2 || limits.scatter < 1)
        return "max_depth is below 2 or max_scatter below 1";
    if (!around_camera.empty())
        return "the camera is inside glass";
    if (!scene.camera_is_invertible)
        return "the camera sees directions several times";
    if (has_narrow_peak(scene.medium->phase()))
        return "the fog's anisotropy is outside -0.6 to 0.9";
    if (is_dense_and_white(scene))
        return "the fog is so dense and white that light wanders through all of the scene";
    if (scene.hides_beyond_camera || scene.techniques_differ)
        return "objects or lights that some rays do not see, lamps without shadows or with a limit of bounces";
    if (scene.has_subsurface)
        return "light wanders beneath surfaces";
    if (!has_light_to_start_at(scene))
        return "no light but from infinity";
    return nullptr;
}

} // namespace

LightVertexCache::LightVertexCache(const Scene &scene, const DepthLimits &limits, const InteriorStack &around_camera,
                                   bool grouped)
    : scene_(scene), around_camera_(around_camera), settings_(make_vpl_settings(scene, limits, around_camera)) {
    settings_.grouped = grouped;
}

std::unique_ptr<const WaveData> LightVertexCache::prepare_wave(uint64_t seed, uint64_t sample,
                                                               TraceContext &rays) const {
    auto wave = std::make_unique<LightVertexWave>();
    wave->seed = seed;
    wave->sample = sample;
    wave->time = time_of_wave(seed, sample);
    Sampler sampler = make_stream(Stream::wave, seed, sample, 0, 0);
    const FilmSettings &film = scene_.film;
    const Rectangle picture{film.crop_x, film.crop_y, film.crop_width, film.crop_height};
    const ImportanceMap importance(scene_, sample_gather_points(scene_, picture, around_camera_,
                                                                tuning::kImportancePoints, wave->time, sampler, rays));
    wave->vertices = trace_light_subpaths(scene_, importance, settings_, wave->time, sampler, rays);
    sort_in_space(wave->vertices);
    return wave;
}

std::unique_ptr<const BlockData> LightVertexCache::prepare_block(const WaveData &data, const Rectangle &block,
                                                                 TraceContext &rays) const {
    const auto &wave = static_cast<const LightVertexWave &>(data);
    Sampler sampler = make_stream(Stream::block, wave.seed, wave.sample, block.x, block.y);
    const std::vector<Vec3f> points =
        sample_gather_points(scene_, block, around_camera_, tuning::kBlockPoints, wave.time, sampler, rays);
    auto shared = std::make_unique<LightVertexBlock>(
        settings_, BlockVertices(scene_, wave.vertices, settings_, points, wave.time, sampler), block);
    for (const Splat &s : wave.vertices.splats)
        if (s.x - block.x < block.width && s.y - block.y < block.height) // unsigned, so not before the block either
            shared->add(s);
    shared->unfinished = wave.vertices.unfinished;
    return shared;
}

LightVertexPlan plan_light_vertex_cache(const Scene &scene, const DepthLimits &limits,
                                        const InteriorStack &around_camera, bool grouped) {
    if (!scene.medium || !scene.medium->scatters())
        return {};
    if (const char *reason = reason_against(scene, limits, around_camera))
        return {nullptr, std::string("no light vertices shared by all pixels, fog is slower: ") + reason};
    return {std::make_unique<LightVertexCache>(scene, limits, around_camera, grouped), {}};
}

} // namespace glimmer
