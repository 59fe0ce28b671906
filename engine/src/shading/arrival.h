// SPDX-License-Identifier: GPL-3.0-or-later
// How a ray reached the place that a shader program is evaluated at.
#pragma once

#include <cstdint>

namespace glimmer {

enum RayFlags : uint8_t {
    kCameraRay = 1,
    kShadowRay = 2,
    kDiffuseRay = 4,
    kGlossyRay = 8,
    kSingularRay = 16,
    kReflectionRay = 32,
    kTransmissionRay = 64,
    kVolumeScatterRay = 128
};

struct Arrival {
    uint8_t flags = kCameraRay;
    float depth = 0;  ///< scattering vertices before
    float length = 0; ///< of the last segment
};

/// A light that is sampled, and light vertices, cannot know who asks: a diffuse surface, for all that programs know.
inline constexpr Arrival kFromDiffuse{kDiffuseRay | kReflectionRay, 1, 0};
inline constexpr Arrival kFromShadow{kShadowRay, 1, 0};

} // namespace glimmer
