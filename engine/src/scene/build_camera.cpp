// SPDX-License-Identifier: GPL-3.0-or-later
// The camera, the film and its filter.
#include "scene/build_camera.h"

#include "base/error.h"
#include "scene/builder.h"

#include <algorithm>
#include <cmath>

namespace glimmer {

namespace {

CameraBase camera_base(const glimmer_camera_desc &c, const Affine &to_world, float aspect, double half_width) {
    CameraBase camera;
    camera.right = Vec3f(to_world.linear.column(0));
    camera.up = Vec3f(to_world.linear.column(1));
    camera.forward = -Vec3f(to_world.linear.column(2));
    camera.half_width = float(half_width);
    camera.aspect = aspect;
    camera.shift = {float(c.shift[0]), float(c.shift[1])};
    const double reach = std::max(1.0, 1 / c.aperture_ratio);
    camera.lens_radius = float(c.lens_radius * reach);
    camera.aperture = {c.aperture_blades,
                       float(c.aperture_rotation * kPiDouble / 180),
                       {float(1 / c.aperture_ratio / reach), float(1 / reach)}};
    camera.focus_distance = float(c.focus_distance);
    camera.clip_start = float(c.clip_start);
    camera.clip_end = float(c.clip_end);
    if (c.type != GLIMMER_ORTHOGRAPHIC)
        camera.stereo = {float(c.stereo_offset), float(c.stereo_convergence),
                         float(c.stereo_merge[0] * kPiDouble / 180), float(c.stereo_merge[1] * kPiDouble / 180)};
    return camera;
}

/// What the filter adds to the film at each side, as a part of its width and height.
Vec2f filter_margin(const FilmSettings &film) {
    const float margin = 0.5f * (film.filter.width() - 1);
    return {margin / float(film.width), margin / float(film.height)};
}

Camera make_camera(const glimmer_camera_desc &c, const Affine &to_world, const FilmSettings &film) {
    const float aspect = film.aspect();
    if (c.type > GLIMMER_ORTHOGRAPHIC) {
        const Panorama panorama = make_panorama(c, film);
        return PanoramicCamera{camera_base(c, to_world, aspect, panorama.angle_per_width(aspect) / 2), panorama};
    }
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

Panorama make_panorama(const glimmer_camera_desc &c, const FilmSettings &film) {
    constexpr double kDegree = kPiDouble / 180;
    Panorama p;
    p.type = PanoramaType(int(c.type) - int(GLIMMER_EQUIRECTANGULAR));
    p.window = {{float(c.window[0]), float(c.window[1])}, {float(c.window[2]), float(c.window[3])}};
    p.aspect = float(double(film.height) / (double(film.width) * double(film.pixel_aspect)) *
                     (c.window[2] - c.window[0]) / (c.window[3] - c.window[1]));
    for (int i = 0; i < 2; ++i) {
        p.longitude[i] = float(c.longitude[i] * kDegree);
        p.latitude[i] = float(c.type == GLIMMER_CYLINDRICAL ? c.elevation[i] : c.latitude[i] * kDegree);
    }
    p.half_angle = float(c.fisheye_fov * kDegree / 2);
    p.focal_length = float(c.focal_length);
    for (size_t i = 0; i < p.polynomial.size(); ++i)
        p.polynomial[i] = float(c.polynomial[i]);
    p.reach = p.farthest(filter_margin(film));
    return p;
}

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

    FilmSettings &film = scene_.film;
    film.width = f.width;
    film.height = f.height;
    const bool whole = f.crop[2] == 0 && f.crop[3] == 0;
    film.crop_x = whole ? 0 : f.crop[0];
    film.crop_y = whole ? 0 : f.crop[1];
    film.crop_width = whole ? f.width : f.crop[2] - f.crop[0];
    film.crop_height = whole ? f.height : f.crop[3] - f.crop[1];
    film.exposure = f.exposure;
    film.transparent = f.transparent != 0;
    film.transparent_width = f.transparent_glass;
    film.occlusion_distance = f.occlusion_distance;
    film.pixel_aspect = f.pixel_aspect;
    film.mist_start = f.mist_start, film.mist_depth = f.mist_depth, film.mist_falloff = f.mist_falloff;
    if (f.filter == GLIMMER_BLACKMAN_HARRIS)
        film.filter = PixelFilter::blackman_harris(f.filter_width);

    scene_.camera = make_camera(c, to_world, film);
    scene_.camera_is_invertible = scene_.camera.is_invertible(filter_margin(film));
    if (!motion.empty())
        scene_.camera.set_motion(make_motion(motion, origin_));
}

} // namespace glimmer
