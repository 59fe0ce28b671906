// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/camera_sample.h"

#include <algorithm>

namespace glimmer {

namespace {

float filter_offset(const FilmSettings &film, float u) {
    if (film.filter_inverse.empty())
        return u - 0.5f;
    const float x = u * float(film.filter_inverse.size() - 1);
    const size_t i = std::min(size_t(x), film.filter_inverse.size() - 2);
    const float f = x - float(i);
    return (film.filter_inverse[i] * (1 - f) + film.filter_inverse[i + 1] * f) * film.filter_width;
}

} // namespace

CameraRay sample_camera_ray(const Scene &scene, uint32_t pixel_x, uint32_t pixel_y, Vec2f u_pixel, Vec2f u_lens,
                            ShutterTime time) {
    const FilmSettings &film = scene.film;
    const Vec2f at{(float(pixel_x) + 0.5f + filter_offset(film, u_pixel.x)) / float(film.width),
                   (float(pixel_y) + 0.5f + filter_offset(film, u_pixel.y)) / float(film.height)};
    CameraRay ray = scene.camera.generate(at, scene.camera.has_lens() ? sample_uniform_disk(u_lens) : Vec2f{}, time);
    ray.pixel_x = pixel_x;
    ray.pixel_y = pixel_y;
    return ray;
}

float filter_density(const FilmSettings &film, float offset) {
    if (film.filter_inverse.empty())
        return offset >= -0.5f && offset < 0.5f ? 1.0f : 0.0f;
    // The samples fall evenly between the entries of the inverse CDF.
    const std::vector<float> &inverse = film.filter_inverse;
    const float x = offset / film.filter_width;
    const auto above = std::upper_bound(inverse.begin(), inverse.end(), x);
    if (above == inverse.begin() || above == inverse.end())
        return 0;
    return 1 / ((*above - *(above - 1)) * film.filter_width * float(inverse.size() - 1));
}

} // namespace glimmer
