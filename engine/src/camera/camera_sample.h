// SPDX-License-Identifier: GPL-3.0-or-later
// From a pixel and random numbers to a camera ray, by way of the filter and the lens.
#pragma once

#include "sampling/warp.h"
#include "scene/scene.h"

#include <algorithm>

namespace glimmer {

/// Through the point that is `offset` pixels from the middle of a pixel of the whole picture, or of those around it
/// (a negative number as a signed one has it).
CameraRay camera_ray_at(const Scene &scene, uint32_t pixel_x, uint32_t pixel_y, Vec2f offset, Vec2f u_lens,
                        ShutterTime time);
/// By filter importance sampling: every sample counts the same and none leaves its pixel's sum.
CameraRay sample_camera_ray(const Scene &scene, uint32_t pixel_x, uint32_t pixel_y, Vec2f u_pixel, Vec2f u_lens,
                            ShutterTime time);

/// One of `size` rows or columns of pixels from `first` on.
inline uint32_t pick_pixel(uint32_t first, uint32_t size, float u) {
    return first + std::min(uint32_t(u * float(size)), size - 1);
}

} // namespace glimmer
