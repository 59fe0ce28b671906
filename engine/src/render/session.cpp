// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/session.h"

#include "base/error.h"
#include "base/float_mode.h"
#include "render/checkpoint.h"
#include "render/reconstruction.h"
#include "render/report.h"

#include <algorithm>
#include <cmath>
#include <system_error>

namespace glimmer {

namespace {

constexpr uint64_t kDefaultSamples = 64;

RenderSettings completed(RenderSettings settings) {
    if (!settings.samples && settings.seconds <= 0 && settings.target_error <= 0)
        settings.samples = kDefaultSamples;
    if (!settings.threads)
        settings.threads = std::max(std::thread::hardware_concurrency(), 1u);
    return settings;
}

bool is_power_of_two(uint64_t n) {
    return (n & (n - 1)) == 0;
}

} // namespace

Session::Session(std::shared_ptr<const Scene> scene, const RenderSettings &settings)
    : scene_(std::move(scene)), settings_(completed(settings)),
      integrator_(
          make_integrator(settings.integrator, *scene_, settings.limits, settings.passes, settings.full_kernel)),
      film_(scene_->film.crop_width, scene_->film.crop_height, settings.tile_size, settings.passes, settings.adaptive,
            film_reach(*scene_, *integrator_, settings)),
      schedule_(film_.tiles().size(), integrator_->shares(), settings_.samples),
      tile_renderer_(*scene_, *integrator_, schedule_, settings.seed, stop_), curve_(settings.target_error),
      changed_tiles_(film_.tiles().size()) {}

Session::~Session() {
    cancel();
    for (std::thread &worker : workers_)
        worker.join();
}

// -- What a caller does

void Session::start() {
    Lock lock(mutex_);
    if (state_ != GLIMMER_READY)
        fail_state("the render was started before");
    state_ = GLIMMER_RUNNING;
    clock_.start();
    allocate_film(lock);
    if (is_alive())
        begin_batch();
    if (!is_alive())
        return;
    for (uint32_t i = 0; i < settings_.threads; ++i)
        try {
            workers_.emplace_back([this] { work(); });
            ++alive_; // they wait for the lock
        } catch (const std::system_error &) {
            if (workers_.empty())
                return fail(std::current_exception());
            break; // fewer do as well
        }
}

void Session::pause() {
    Lock lock(mutex_);
    if (state_ != GLIMMER_RUNNING)
        return;
    state_ = GLIMMER_PAUSED;
    clock_.stop();
    changed_.wait(lock, [this] { return state_ != GLIMMER_PAUSED || (busy_ == 0 && !between_batches_); });
}

void Session::resume() {
    const Lock lock(mutex_);
    if (state_ != GLIMMER_PAUSED)
        return;
    state_ = GLIMMER_RUNNING;
    clock_.start();
    changed_.notify_all();
}

void Session::cancel() {
    const Lock lock(mutex_);
    if (state_ == GLIMMER_READY || is_alive()) {
        cancelled_ = true;
        finish(GLIMMER_CANCELLED);
    }
}

bool Session::wait(double seconds) {
    Lock lock(mutex_);
    const auto ended = [this] { return state_ >= GLIMMER_FINISHED && alive_ == 0; };
    if (state_ == GLIMMER_READY)
        fail_state("the render was not started");
    if (seconds < 0)
        changed_.wait(lock, ended);
    else
        changed_.wait_for(lock, std::chrono::duration<double>(std::min(seconds, 1e6)), ended);
    if (failure_)
        std::rethrow_exception(failure_);
    return ended();
}

void Session::finish(glimmer_render_state state) {
    if (state_ == GLIMMER_RUNNING)
        clock_.stop();
    state_ = state;
    stop_ = true;
    changed_.notify_all();
}

void Session::fail(const std::exception_ptr &failure) {
    if (!failure_)
        failure_ = failure;
    finish(GLIMMER_FAILED);
}

// -- What a worker does

void Session::work() {
    const FloatMode mode; // threads inherit the host's, which may flush denormals to zero
    Lock lock(mutex_);
    while (is_alive()) {
        const bool may_work = state_ == GLIMMER_RUNNING && !between_batches_;
        if (const auto wave = may_work ? schedule_.take_wave() : std::nullopt) {
            prepare_wave(*wave, lock);
        } else if (const auto tile = may_work ? schedule_.take_tile() : std::nullopt) {
            render_tile(*tile, lock);
        } else {
            changed_.wait(lock);
            continue; // nothing changed: two that woke each other here would keep a core busy
        }
        changed_.notify_all();
    }
    // The last one out adds the last point of the curve, of whatever was finished. A cancel does not wait for it.
    if (alive_ == 1 && state_ == GLIMMER_FINISHED)
        add_curve_point(film_.min_samples(), lock);
    --alive_;
    changed_.notify_all();
}

template <class Task>
bool Session::run_unlocked(Lock &lock, const Task &task) {
    ++busy_;
    lock.unlock();
    TraceContext trace{0, &stop_};
    std::exception_ptr failure;
    const uint64_t cpu_start = thread_cpu_nanoseconds();
    try {
        task(trace);
    } catch (...) {
        failure = std::current_exception();
    }
    cpu_nanoseconds_ += thread_cpu_nanoseconds() - cpu_start;
    rays_ += trace.rays;
    lock.lock();
    --busy_;
    if (failure)
        fail(failure);
    return !failure;
}

void Session::prepare_wave(uint64_t wave, Lock &lock) {
    std::unique_ptr<const WaveData> data;
    if (run_unlocked(lock, [&](TraceContext &trace) { data = integrator_->prepare_wave(settings_.seed, wave, trace); }))
        schedule_.put_wave(wave, std::move(data));
}

void Session::render_tile(size_t tile, Lock &lock) {
    const uint64_t first = film_.tile_samples(tile), end = schedule_.end_wave();
    // The first batch is always finished: a picture with holes is none.
    const double deadline = settings_.seconds > 0 && first > 0 ? clock_.moment_of(settings_.seconds) : HUGE_VAL;
    std::optional<SampleFaults> faults;
    double seconds = 0;
    if (!run_unlocked(lock, [&](TraceContext &trace) {
            const double start = steady_seconds();
            // A resumed batch may have been ahead here.
            faults = first < end ? tile_renderer_.render(film_, tile, first, deadline, trace) : SampleFaults{};
            seconds = steady_seconds() - start;
        }))
        return;
    if (!faults) {
        // Only the time limit breaks a tile off before the end. Paused or not, the batch cannot be completed then.
        if (is_alive())
            finish(GLIMMER_FINISHED);
        return;
    }
    faults_.add(*faults);
    for (const size_t t : film_.tiles_changed_by(tile))
        changed_tiles_.add(t);
    ++version_;
    if (schedule_.put_tile(first < end ? seconds / double(end - first) : 0))
        end_batch(lock);
}

// -- Between batches: one worker is here, and the others wait

void Session::end_batch(Lock &lock) {
    const uint64_t samples = schedule_.end_wave();
    between_batches_ = true;
    if (is_power_of_two(samples) || samples == settings_.samples)
        add_curve_point(samples, lock);
    if (is_alive()) {
        const bool late = settings_.seconds > 0 && clock_.elapsed() >= settings_.seconds;
        if (curve_.meets_target() || late) {
            finish(GLIMMER_FINISHED);
        } else {
            allocate_film(lock);
            if (is_alive())
                begin_batch();
        }
    }
    between_batches_ = false;
}

void Session::begin_batch() {
    if (!schedule_.begin_batch(film_.min_samples()))
        finish(GLIMMER_FINISHED);
}

void Session::add_curve_point(uint64_t samples, Lock &lock) {
    if (curve_.has_point_at(samples))
        return;
    between_batches_ = true;
    const uint32_t look = curve_.looks() + 1;
    lock.unlock();
    const std::optional<ErrorEstimate> error = estimate_error(film_, look, cancelled_);
    lock.lock();
    between_batches_ = false;
    if (error)
        curve_.add({clock_.elapsed(), cpu_seconds(), samples, *error});
}

/// Allocates the samples of an adaptive film when it is time.
void Session::allocate_film(Lock &lock) {
    if (!film_.adaptive() || film_.allocated() || film_.min_samples() < kUniformWaves)
        return;
    between_batches_ = true;
    lock.unlock();
    const std::vector<PixelAllocation> allocation = allocate_samples(film_, cancelled_);
    if (!allocation.empty())
        film_.set_allocation(allocation);
    lock.lock();
    between_batches_ = false;
    changed_.notify_all();
}

// -- What a caller reads

double Session::until(double seconds) const {
    return std::isfinite(seconds) ? std::max(seconds - clock_.elapsed(), 0.0) : -1;
}

glimmer_progress Session::progress() {
    const Lock lock(mutex_);
    const ErrorEstimate error = curve_.error();
    const Forecast &forecast = curve_.forecast();
    glimmer_progress p{};
    p.struct_size = sizeof p;
    p.state = state_;
    p.samples = film_.min_samples();
    p.seconds = clock_.elapsed();
    p.cpu_seconds = cpu_seconds();
    double fraction = 0;
    if (settings_.samples)
        fraction = std::min(schedule_.waves_done() / double(settings_.samples), 1.0);
    if (settings_.seconds > 0)
        fraction = std::max(fraction, std::min(p.seconds / settings_.seconds, 1.0));
    p.seconds_to_half = until(forecast.half);
    p.seconds_to_target = until(forecast.target);
    if (forecast.target > 0)
        fraction = std::max(fraction, std::min(p.seconds / forecast.target, 1.0));
    p.fraction = state_ == GLIMMER_FINISHED ? 1 : fraction;
    p.seconds_left = p.fraction > 0 ? p.seconds * (1 - p.fraction) / p.fraction : -1;
    p.relmse = error.relmse;
    p.relmse_low = error.low;
    p.relmse_high = error.high;
    p.heavy_tails = error.has_interval() && !error.certifiable();
    p.largest_share = error.largest_share;
    p.largest_x = error.x;
    p.largest_y = error.y;
    p.rate = curve_.rate().power;
    p.rate_low = curve_.rate().low;
    p.rate_high = curve_.rate().high;
    p.rays = rays_;
    p.peak_bytes = film_.bytes() + scene_->bytes + schedule_.peak_shared_bytes();
    p.invalid_samples = faults_.invalid;
    p.version = version_;
    return p;
}

bool Session::next_tile(glimmer_tile &tile) {
    const Lock lock(mutex_);
    const std::optional<size_t> i = changed_tiles_.take();
    if (!i)
        return false;
    const Rectangle &r = film_.tiles()[*i];
    tile = {r.x, r.y, r.width, r.height, film_.tile_samples(*i)};
    return true;
}

std::string Session::report() {
    const glimmer_progress now = progress();
    std::optional<std::array<uint64_t, 2>> taken;
    if (film_.adaptive()) // of a large picture this takes a while: workers must not wait for it
        taken = film_.samples_taken();
    const Lock lock(mutex_);
    return report_json({*scene_, *integrator_, settings_, now, curve_, faults_, taken});
}

std::vector<uint8_t> Session::save() {
    const Lock lock(mutex_);
    if (state_ == GLIMMER_RUNNING || busy_ || between_batches_)
        fail_state("a running render cannot be saved; pause it first");
    return write_checkpoint(settings_, {rays_, clock_.elapsed(), cpu_seconds(), faults_, curve_.points()}, film_);
}

void Session::load(const uint8_t *data, size_t size) {
    const Lock lock(mutex_);
    if (state_ != GLIMMER_READY)
        fail_state("a saved state can only be loaded before the render starts");
    Progress progress = read_checkpoint(data, size, settings_, film_);
    rays_ = progress.rays;
    faults_ = progress.faults;
    clock_.restore(progress.seconds);
    earlier_cpu_seconds_ = progress.cpu_seconds;
    curve_.restore(std::move(progress.curve));
    for (size_t i = 0; i < film_.tiles().size(); ++i)
        if (film_.tile_samples(i) > 0)
            changed_tiles_.add(i);
    ++version_;
}

} // namespace glimmer
