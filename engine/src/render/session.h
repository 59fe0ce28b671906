// SPDX-License-Identifier: GPL-3.0-or-later
// A render under way: worker threads that take what the schedule has next, until a limit is met. The session is the
// threads, their lock and the state of the render; what is decided under that lock stands in files of its own.
#pragma once

#include "film/film.h"
#include "integrator/registry.h"
#include "render/changed_tiles.h"
#include "render/clock.h"
#include "render/error_curve.h"
#include "render/render_settings.h"
#include "render/sample_faults.h"
#include "render/schedule.h"
#include "render/tile_renderer.h"
#include "scene/scene.h"

#include <condition_variable>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace glimmer {

class Session {
  public:
    Session(std::shared_ptr<const Scene> scene, const RenderSettings &settings);
    /// Cancels, and waits for the workers.
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
    std::string report();
    std::vector<uint8_t> save();
    void load(const uint8_t *data, size_t size);

  private:
    using Lock = std::unique_lock<std::mutex>;

    bool is_alive() const { return state_ == GLIMMER_RUNNING || state_ == GLIMMER_PAUSED; }
    double cpu_seconds() const { return earlier_cpu_seconds_ + double(cpu_nanoseconds_) * 1e-9; }
    /// Seconds from now until the render has run so long, never less than 0; negative where that is not known.
    double until(double seconds) const;

    // All of these are called with the lock held. Those that take it let it go while they work.
    void work();
    /// Runs what takes long; false where it failed, and the render with it.
    template <class Task>
    bool run_unlocked(Lock &lock, const Task &task);
    void prepare_wave(uint64_t wave, Lock &lock);
    void render_tile(size_t tile, Lock &lock);
    void end_batch(Lock &lock);
    void begin_batch();
    void add_curve_point(uint64_t samples, Lock &lock);
    void allocate_film(Lock &lock);
    void finish(glimmer_render_state state);
    void fail(const std::exception_ptr &failure);

    std::shared_ptr<const Scene> scene_;
    RenderSettings settings_;
    std::unique_ptr<const Integrator> integrator_;
    Film film_;
    std::atomic<bool> stop_{false}, cancelled_{false}; ///< ended; ended in a hurry
    std::atomic<uint64_t> rays_{0}, cpu_nanoseconds_{0}, version_{0};
    std::vector<std::thread> workers_;

    std::mutex mutex_; ///< of everything below
    std::condition_variable changed_;
    glimmer_render_state state_ = GLIMMER_READY;
    std::exception_ptr failure_;
    Schedule schedule_;
    TileRenderer tile_renderer_;
    bool between_batches_ = false;
    uint32_t busy_ = 0, alive_ = 0; ///< workers that run something unlocked; workers
    ErrorCurve curve_;
    SampleFaults faults_;
    ChangedTiles changed_tiles_;
    RenderClock clock_;
    double earlier_cpu_seconds_ = 0; ///< before the present run, by a checkpoint
};

} // namespace glimmer
