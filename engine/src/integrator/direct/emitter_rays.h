// SPDX-License-Identifier: GPL-3.0-or-later
// Spheres that shine, as the camera sees them. Their rims against a dark sky decide the error of a picture that is good
// elsewhere, and a camera ray alone costs a small part of a sample: pixels that a disc touches get more of them.
#pragma once

#include "integrator/trace_context.h"
#include "sampling/sampler.h"
#include "scene/scene.h"

#include <vector>

namespace glimmer {

inline constexpr uint32_t kLightRays = 16; ///< more, a sample

class EmitterRays {
  public:
    /// rays: more camera rays a sample, a square number; 0: none.
    EmitterRays(const Scene &scene, uint32_t rays);

    /// How many more rays the pixel gets: the same for all of its samples, or the mean would suffer.
    uint32_t rays(uint32_t pixel_x, uint32_t pixel_y) const;

    /// The sum over so many rays of the radiance of the spheres that they meet, stratified over filter and pixel.
    Rgb sum(uint32_t rays, uint32_t pixel_x, uint32_t pixel_y, Sampler &sampler, TraceContext &trace) const;

  private:
    const Scene &scene_;
    uint32_t rays_;
    std::vector<Silhouette> discs_; ///< of the spheres, widened by half a pixel and its filter
};

} // namespace glimmer
