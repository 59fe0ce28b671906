// SPDX-License-Identifier: GPL-3.0-or-later
// More camera rays in pixels where emissive spheres are seen. Their silhouettes against a dark background have most of
// the error of a picture that is good elsewhere, and a camera ray alone costs a small part of a sample.
#pragma once

#include "integrator/trace_context.h"
#include "sampling/sampler.h"
#include "scene/scene.h"

#include <vector>

namespace glimmer {

class EmitterRays {
  public:
    /// rays: camera rays that a sample adds, a square number; 0: none.
    EmitterRays(const Scene &scene, uint32_t rays);

    /// How many rays the pixel's samples add: `rays` where a sphere may be seen, else 0. The same for all samples of a
    /// pixel, since each ray of a sample has the same weight.
    uint32_t rays(uint32_t pixel_x, uint32_t pixel_y) const;

    /// The sum over so many camera rays, stratified over the pixel's filter, of the emission of the spheres they meet.
    /// groups: where not null, each emission is added to the group of its sphere as well.
    Rgb sum(uint32_t rays, uint32_t pixel_x, uint32_t pixel_y, ShutterTime time, Sampler &sampler, TraceContext &trace,
            LightGroups *groups) const;

  private:
    const Scene &scene_;
    uint32_t rays_;
    std::vector<Silhouette> discs_; ///< of the spheres, widened by half a pixel and its filter
};

} // namespace glimmer
