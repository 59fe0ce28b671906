// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/vpl/vpl_settings.h"

#include "integrator/shutter.h"
#include "integrator/vpl/gather_points.h"
#include "integrator/vpl/light_subpaths.h"
#include "integrator/vpl/streams.h"
#include "medium/phase.h"

#include <vector>

namespace glimmer {

namespace {

/// The upper of the two middle values of an even count. Not empty.
float median(std::vector<float> &values) {
    const auto middle = values.begin() + long(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Keeps the number of vertices of a wave near the limit.
void limit_vertices(VplSettings &settings, uint32_t pilot_paths, size_t pilot_vertices) {
    if (pilot_vertices > tuning::kMostVertices / settings.paths * pilot_paths)
        settings.paths = std::max(uint32_t(uint64_t(tuning::kMostVertices) * pilot_paths / pilot_vertices),
                                  tuning::kFewestPathsOfManyVertices);
}

/// Vertices per volume about each point, from the distance to the kPilotNeighbours-th of them; empty where there are
/// fewer.
std::vector<float> densities_about(const std::vector<Vec3f> &points, const MediumVertices &vertices) {
    const long nearest = tuning::kPilotNeighbours;
    std::vector<float> densities;
    for (const Vec3f &q : points) {
        std::vector<float> d2;
        for (size_t j = 0; j < vertices.size(); ++j)
            d2.push_back(length_squared(vertices.position(j) - q));
        if (long(d2.size()) < nearest)
            continue;
        std::nth_element(d2.begin(), d2.begin() + nearest - 1, d2.end());
        const float r = std::sqrt(d2[size_t(nearest - 1)]);
        densities.push_back(float(nearest) / (4.0f / 3 * kPi * r * r * r));
    }
    return densities;
}

/// d0^2 = sigma / (4 pi density): a vertex at that distance brings about as much as all light of its neighbourhood.
float clamp_distance(const Medium &medium, std::vector<float> &pilot_densities, uint32_t pilot_paths, uint32_t paths) {
    const float sigma = medium.majorant();
    float d0 = tuning::kClampDistanceWithoutVertices / sigma;
    if (!pilot_densities.empty()) {
        const float density = median(pilot_densities) * float(paths) / float(pilot_paths);
        d0 = std::min(std::sqrt(sigma / (4 * kPi * density)), tuning::kMostClampDistance / sigma);
    }
    return d0 * std::pow(medium.phase().peak() / kIsotropicPhase, tuning::kClampPowerOfPhasePeak);
}

} // namespace

VplSettings make_vpl_settings(const Scene &scene, const DepthLimits &limits, const InteriorStack &around_camera) {
    VplSettings settings;
    settings.limits = limits;
    const FilmSettings &film = scene.film;
    const uint32_t pixels = film.crop_width * film.crop_height;
    const bool reflects = scene.has_surfaces && scene.max_value > 0; // black surfaces only stand in the way
    const uint32_t pixels_per_path = reflects ? tuning::kPixelsPerPath : tuning::kPixelsPerPathInMediumAlone;
    settings.paths = std::clamp(pixels / pixels_per_path, tuning::kFewestPaths, tuning::kMostPaths);
    settings.gathers = reflects ? tuning::kGathers : tuning::kGathersInMediumAlone;

    TraceContext rays;
    Sampler sampler = make_stream(Stream::pilot, 0, 0, 0, 0);
    const Rectangle picture{film.crop_x, film.crop_y, film.crop_width, film.crop_height};
    const std::vector<Vec3f> points =
        sample_gather_points(scene, picture, around_camera, tuning::kPilotPoints, kMidShutter, sampler, rays);
    VplSettings pilot_settings = settings;
    pilot_settings.paths = std::min(settings.paths, tuning::kMostPilotPaths);
    const ImportanceMap importance(scene, sample_gather_points(scene, picture, around_camera, tuning::kImportancePoints,
                                                               kMidShutter, sampler, rays));
    const LightVertices pilot = trace_light_subpaths(scene, importance, pilot_settings, kMidShutter, sampler, rays);
    limit_vertices(settings, pilot_settings.paths, std::max(pilot.medium.size(), pilot.surface.size()));

    std::vector<float> densities = densities_about(points, pilot.medium);
    settings.medium_clamp_distance = clamp_distance(*scene.medium, densities, pilot_settings.paths, settings.paths);
    settings.surface_clamp_distance = tuning::kSurfaceClampFactor * settings.medium_clamp_distance;
    std::vector<float> distances;
    for (const Vec3f &q : points)
        distances.push_back(scene.camera.distance(q));
    if (!distances.empty()) {
        settings.median_distance = median(distances);
        settings.splat_clamp_distance = tuning::kSplatClampFactor * scene.camera.footprint(settings.median_distance);
    }
    settings.effective_attenuation = scene.medium->effective_attenuation();
    return settings;
}

} // namespace glimmer
