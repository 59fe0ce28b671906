// SPDX-License-Identifier: GPL-3.0-or-later
// A render under way: worker threads take tiles of a batch of passes, one batch after the other, until a limit is met.
#pragma once

#include "film/film.h"
#include "integrator/integrator.h"
#include "render/rate.h"
#include "scene/scene.h"

#include <condition_variable>
#include <deque>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace glimmer {

struct RenderSettings {
    uint32_t integrator = 0;
    uint64_t samples = 0;
    double seconds = 0, target_error = 0;
    uint64_t seed = 0;
    uint32_t threads = 0, tile_size = 64, passes = 1;
    DepthLimits limits;
    bool adaptive = false;    ///< film/sample_allocation.h
    bool full_kernel = false; ///< make_integrator
};

struct InvalidSample {
    uint32_t x, y;
    uint64_t sample;
};

class Session {
  public:
    Session(std::shared_ptr<const Scene> scene, const RenderSettings &settings);
    ~Session();

    void start();
    void pause();
    void resume();
    void cancel();
    /// Whether the render has ended within the time (negative: no limit). Throws what made it fail.
    bool wait(double seconds);

    glimmer_progress progress();
    bool next_tile(glimmer_tile &tile);
    const Film &film() const { return film_; }
    std::string report_json();
    std::vector<uint8_t> save();
    void load(const uint8_t *data, size_t size);

  private:
    struct Batch {
        uint64_t first = 0, count = 0;
        std::vector<std::unique_ptr<const WaveData>> passes; ///< what they share; empty where they share nothing
        size_t next_pass = 0, done_passes = 0, shared_bytes = 0;
        size_t next_tile = 0, done_tiles = 0;
    };

    void work();
    /// Adds samples [first, end) to a tile; false when it was broken off (nothing of it is kept then).
    bool render_tile(size_t tile, uint64_t first, uint64_t end, double deadline, TraceContext &rays);
    void take_pass(size_t index, std::unique_lock<std::mutex> &lock);
    void fail(const std::exception_ptr &failure);
    void take_tile(size_t tile, std::unique_lock<std::mutex> &lock);
    void add_curve_point(uint64_t samples, std::unique_lock<std::mutex> &lock);
    void judge_curve();
    void plan_film(std::unique_lock<std::mutex> &lock);
    void end_batch(std::unique_lock<std::mutex> &lock);
    void plan_batch();
    void finish(glimmer_render_state state);
    double elapsed() const;
    /// Seconds from now until then, never less than 0; negative where `then` is not known.
    double until(double then) const;

    std::shared_ptr<const Scene> scene_;
    RenderSettings settings_;
    std::unique_ptr<const Integrator> integrator_;
    Film film_;
    std::vector<std::thread> workers_;

    std::mutex mutex_; ///< of everything below
    std::condition_variable changed_;
    glimmer_render_state state_ = GLIMMER_READY;
    std::exception_ptr failure_;
    Batch batch_;
    bool between_batches_ = false;
    uint32_t busy_ = 0, alive_ = 0;                    ///< workers within a tile; workers
    std::atomic<bool> stop_{false}, cancelled_{false}; ///< ended; ended in a hurry
    std::atomic<uint64_t> rays_{0}, cpu_nanoseconds_{0}, version_{0};
    uint64_t samples_ = 0;         ///< every pixel has them
    size_t most_shared_bytes_ = 0; ///< of a batch's passes
    std::vector<CurvePoint> curve_;
    ErrorEstimate error_; ///< the curve's last
    FallRate rate_;
    Forecast forecast_;
    uint64_t invalid_count_ = 0, unfinished_count_ = 0;
    std::vector<InvalidSample> invalid_; ///< the first one, if any
    std::vector<bool> dirty_;
    std::deque<size_t> dirty_order_;
    double earlier_seconds_ = 0, earlier_cpu_seconds_ = 0; ///< before the present run: pauses, checkpoints
    double running_since_ = 0;
    double slowest_tile_ = 0; ///< seconds a sample, in the last batch: for planning the next
};

} // namespace glimmer
