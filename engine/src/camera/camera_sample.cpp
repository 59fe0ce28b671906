// SPDX-License-Identifier: GPL-3.0-or-later
#include "camera/camera_sample.h"

namespace glimmer {

CameraRay sample_camera_ray(const Scene &scene, uint32_t pixel_x, uint32_t pixel_y, Vec2f u_pixel, Vec2f u_lens,
                            ShutterTime time) {
    const PixelFilter &filter = scene.film.filter;
    return camera_ray_at(scene, pixel_x, pixel_y, {filter.sample(u_pixel.x), filter.sample(u_pixel.y)}, u_lens, time);
}

CameraRay camera_ray_at(const Scene &scene, uint32_t pixel_x, uint32_t pixel_y, Vec2f offset, Vec2f u_lens,
                        ShutterTime time) {
    const FilmSettings &film = scene.film;
    const Vec2f at{(float(int32_t(pixel_x)) + 0.5f + offset.x) / float(film.width),
                   (float(int32_t(pixel_y)) + 0.5f + offset.y) / float(film.height)};
    CameraRay ray = scene.camera.generate(at, scene.camera.has_lens() ? sample_uniform_disk(u_lens) : Vec2f{}, time);
    ray.pixel_x = pixel_x;
    ray.pixel_y = pixel_y;
    return ray;
}

} // namespace glimmer
