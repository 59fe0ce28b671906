// SPDX-License-Identifier: GPL-3.0-or-later
// The camera, the film and its filter.
#include "base/error.h"
#include "scene/builder.h"

#include <cmath>

namespace glimmer {

namespace {

/// Inverse CDF of the Blackman-Harris window over [-0.5, 0.5] at equal steps of the CDF, for filter importance sampling
/// (Ernst, Stamminger, Greiner 2006): every sample then counts the same and none leaves its pixel. The first and the
/// last step spread evenly over a long tail that is all but empty: with 256 steps it got ten times its light.
std::vector<float> invert_blackman_harris() {
    constexpr int kFine = 65536, kSteps = 4096;
    const auto window = [](double x) { // x in [0, 1]
        const double a = 2 * kPiDouble * x;
        return 0.35875 - 0.48829 * std::cos(a) + 0.14128 * std::cos(2 * a) - 0.01168 * std::cos(3 * a);
    };
    std::vector<double> cdf(kFine + 1, 0.0);
    for (size_t i = 0; i < kFine; ++i)
        cdf[i + 1] = cdf[i] + window((double(i) + 0.5) / kFine);
    std::vector<float> inverse;
    size_t i = 0;
    for (int s = 0; s <= kSteps; ++s) {
        const double target = cdf[kFine] * s / kSteps;
        while (i + 1 < kFine && cdf[i + 1] < target)
            ++i;
        const double f = (target - cdf[i]) / (cdf[i + 1] - cdf[i]);
        inverse.push_back(float((double(i) + std::min(std::max(f, 0.0), 1.0)) / kFine - 0.5));
    }
    return inverse;
}

CameraBase camera_base(const glimmer_camera_desc &c, const Affine &to_world, float aspect, double half_width) {
    CameraBase camera;
    camera.right = Vec3f(to_world.linear.column(0));
    camera.up = Vec3f(to_world.linear.column(1));
    camera.forward = -Vec3f(to_world.linear.column(2));
    camera.half_width = float(half_width);
    camera.aspect = aspect;
    camera.shift = {float(c.shift[0]), float(c.shift[1])};
    camera.lens_radius = float(c.lens_radius);
    camera.focus_distance = float(c.focus_distance);
    camera.clip_start = float(c.clip_start);
    camera.clip_end = float(c.clip_end);
    return camera;
}

Camera make_camera(const glimmer_camera_desc &c, const Affine &to_world, float aspect) {
    if (c.type == GLIMMER_ORTHOGRAPHIC)
        return OrthographicCamera{camera_base(c, to_world, aspect, c.width / 2)};
    return PerspectiveCamera{camera_base(c, to_world, aspect, std::tan(c.fov_x * kPiDouble / 360))};
}

CameraMotion make_motion(const std::vector<Affine> &motion, const Vec3d &origin) {
    std::vector<CameraPose> steps;
    for (const Affine &a : motion)
        steps.push_back({Vec3f(a.linear.column(0)), Vec3f(a.linear.column(1)), -Vec3f(a.linear.column(2)),
                         Vec3f(a.translation - origin)});
    return CameraMotion(std::move(steps));
}

} // namespace

void SceneBuilder::build_camera_and_film() {
    if (!description_.camera)
        fail_state("the scene has no camera; set one before commit");
    if (!description_.film)
        fail_state("the scene has no film; set one before commit");
    const glimmer_camera_desc &c = *description_.camera;
    const glimmer_film_desc &f = *description_.film;

    const std::vector<Affine> &motion = description_.camera_motion;
    const Affine to_world = motion.empty() ? affine_from_rows(c.to_world) : motion[motion.size() / 2];
    scene_.origin = origin_ = to_world.translation;
    scene_.camera = make_camera(c, to_world, float(f.height) / float(f.width));
    if (!motion.empty())
        scene_.camera.set_motion(make_motion(motion, origin_));

    FilmSettings &film = scene_.film;
    film.width = f.width;
    film.height = f.height;
    const bool whole = f.crop[2] == 0 && f.crop[3] == 0;
    film.crop_x = whole ? 0 : f.crop[0];
    film.crop_y = whole ? 0 : f.crop[1];
    film.crop_width = whole ? f.width : f.crop[2] - f.crop[0];
    film.crop_height = whole ? f.height : f.crop[3] - f.crop[1];
    film.filter_width = f.filter_width;
    film.exposure = f.exposure;
    film.transparent = f.transparent != 0;
    film.transparent_width = f.transparent_glass;
    film.mist_start = f.mist_start, film.mist_depth = f.mist_depth, film.mist_falloff = f.mist_falloff;
    if (f.filter == GLIMMER_BLACKMAN_HARRIS)
        film.filter_inverse = invert_blackman_harris();
    else
        film.filter_width = 1;
}

} // namespace glimmer
