// SPDX-License-Identifier: GPL-3.0-or-later
// The interface of all integrators: one camera sample at a time, from random numbers that depend on nothing but the
// pixel, the sample and the seed.
#pragma once

#include "camera/camera.h"
#include "film/sample.h"
#include "integrator/trace_context.h"
#include "integrator/wave.h"
#include "math/rectangle.h"
#include "sampling/sampler.h"

#include <memory>
#include <string>
#include <vector>

namespace glimmer {

class Integrator {
  public:
    virtual ~Integrator() = default;

    /// Whether there is anything to prepare for a wave and for its blocks.
    virtual bool shares() const { return false; }
    /// What all pixels share in sample number `sample`; depends on that number and the seed alone. Broken off, and of
    /// no use, once the trace is stopped.
    virtual std::unique_ptr<const WaveData> prepare_wave(uint64_t /*seed*/, uint64_t /*sample*/,
                                                         TraceContext & /*trace*/) const {
        return nullptr;
    }
    /// What the pixels of one block share in that wave.
    virtual std::unique_ptr<const BlockData> prepare_block(const WaveData & /*wave*/, const Rectangle & /*pixels*/,
                                                           TraceContext & /*trace*/) const {
        return nullptr;
    }
    /// Whether samples are to count for every pixel whose filter holds them, where the film can.
    virtual bool reconstructs() const { return false; }
    /// The weight of SampleParts::seen in a pixel of the whole picture; the pixel's own part brings the rest.
    virtual float weight_of_seen(uint32_t /*pixel_x*/, uint32_t /*pixel_y*/) const { return 1; }
    /// The radiance along one camera ray. block: that of the sample's wave and pixel, or of the block next to a pixel
    /// beyond the picture; null where nothing is shared. parts: takes what counts otherwise than the rest; null: all
    /// counts alike.
    virtual FilmSample sample(const CameraRay &camera, Sampler &sampler, const BlockData *block, TraceContext &trace,
                              SampleParts *parts = nullptr) const = 0;

    /// Names the code that runs, for the report.
    virtual std::string kernel() const = 0;
    /// The features that the scene does not need and the code therefore lacks, one line each, for the report.
    virtual std::vector<std::string> left_out() const = 0;
};

} // namespace glimmer
