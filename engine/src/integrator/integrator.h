// SPDX-License-Identifier: GPL-3.0-or-later
// What every estimator of the picture offers: one camera sample at a time, from random numbers that depend on nothing
// but the pixel, the sample and the seed.
#pragma once

#include "film/sample.h"
#include "glimmer.h"
#include "math/rectangle.h"
#include "sampling/sampler.h"
#include "scene/scene.h"

#include <array>
#include <atomic>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace glimmer {

/// Limits on scattering vertices; a limit is a bias, off by default.
struct DepthLimits {
    uint32_t depth = std::numeric_limits<uint32_t>::max();   ///< surface and volume
    uint32_t scatter = std::numeric_limits<uint32_t>::max(); ///< volume alone
};

/// What a worker's rays are counted in, and where a path that finds no end learns that nobody waits for it any more.
struct TraceContext {
    uint64_t rays = 0;
    const std::atomic<bool> *stop = nullptr; ///< null: never
    bool stopped() const { return stop && stop->load(std::memory_order_relaxed); }
};

inline constexpr uint64_t kCancelCheckInterval = 4096; ///< between looks at it: well below a millisecond
/// Of one camera sample, or of one light path with its branches; reached only where light is shut in for good.
inline constexpr uint64_t kMaxVertices = 1ull << 32;

/// What all pixels of a pass share, and what the pixels of one block of it share.
struct WaveData {
    virtual ~WaveData() = default;
    /// Of its large arrays.
    virtual size_t bytes() const = 0;
};
struct BlockData {
    virtual ~BlockData() = default;
};

/// The side of a block, in pixels of the whole picture: the estimators' own, whatever the tiles are.
inline constexpr uint32_t kBlockSize = 32;

class Integrator {
  public:
    virtual ~Integrator() = default;
    /// Whether passes and blocks share anything.
    virtual bool shares() const { return false; }
    /// For sample number `sample` of every pixel. Depends on it and the seed alone; once `stop` is set, broken off.
    virtual std::unique_ptr<const WaveData> prepare_wave(uint64_t, uint64_t, const std::atomic<bool> &,
                                                         TraceContext &) const {
        return nullptr;
    }
    /// For the pixels of a block in that pass.
    virtual std::unique_ptr<const BlockData> prepare_block(const WaveData &, const Rectangle &, TraceContext &) const {
        return nullptr;
    }
    /// Radiance along the camera ray of one sample. block: of its pass and pixel; null where nothing is shared.
    virtual FilmSample sample(const CameraRay &camera, Sampler &sampler, const BlockData *block,
                              TraceContext &rays) const = 0;
    /// Names the code that runs.
    virtual std::string kernel() const = 0;
    /// What the scene has no use for, a line each.
    virtual std::vector<std::string> left_out() const = 0;
};

/// The default, the yardstick, and the default less one of its estimators each (path_options.h).
inline constexpr std::array<glimmer_integrator_info_t, 12> kIntegrators{{
    {"path", "path tracing; fog by light vertices that all pixels share, the camera's segments of it light by light"},
    {"report", "the student report's method, as a yardstick: one light, exponential free flights, balance heuristic"},
    {"path-no-split",
     "path, where it comes to free flights at all: direct segments of fog end in it or beyond, not both"},
    {"path-no-all-lights", "path, but one light a place, not all"},
    {"path-no-light-rays", "path, but no more camera rays where moons are seen"},
    {"path-no-branches", "path, but one path goes on from the first surface"},
    {"path-no-guided-choice", "path, but single lights are chosen all alike"},
    {"path-no-lines", "path, but no light is sampled along direct segments of fog; so without light vertices"},
    {"path-no-deep-lines", "path, but none along later segments either; so without light vertices"},
    {"path-no-late-roulette", "path, but roulette by throughput from the start"},
    {"path-no-pixel-points", "path, but one point of a pixel is lit where bevels glint"},
    {"path-no-light-vertices", "path, but light scattered more than once comes from paths alone"},
}};

/// `index` into kIntegrators. full_kernel: the code for all scenes, not what was compiled for ones like this.
std::unique_ptr<const Integrator> make_integrator(uint32_t index, const Scene &scene, const DepthLimits &limits,
                                                  bool full_kernel);

} // namespace glimmer
