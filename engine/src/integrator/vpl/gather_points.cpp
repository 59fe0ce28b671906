// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrator/vpl/gather_points.h"

#include "camera/camera_sample.h"

namespace glimmer {

std::vector<Vec3f> sample_gather_points(const Scene &scene, const Rectangle &pixels, const InteriorStack &around_camera,
                                        uint32_t count, ShutterTime time, Sampler &sampler, TraceContext &rays) {
    std::vector<Vec3f> points;
    if (!scene.medium || !around_camera.empty())
        return points;
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t x = pick_pixel(pixels.x, pixels.width, sampler.next_1d()),
                       y = pick_pixel(pixels.y, pixels.height, sampler.next_1d());
        const CameraRay camera = sample_camera_ray(scene, x, y, sampler.next_2d(), sampler.next_2d(), time);
        if (camera.is_blind())
            continue;
        const Ray &ray = camera.ray;
        const auto hit = scene.accel->intersect(ray, RayKind::camera);
        ++rays.rays;
        const float u_channel = scene.medium->monochromatic() ? 0 : sampler.next_1d();
        const uint64_t bits = ~0ull / count * i + sampler.next_bits() / count;
        const Collision c = scene.medium->sample_collision(ray, Rgb(1), hit ? hit->t : kInfinity, u_channel, bits);
        if (c.pdf > 0)
            points.push_back(ray.origin + ray.direction * c.t);
    }
    return points;
}

} // namespace glimmer
