// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/session.h"

#include "api/error.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <immintrin.h>
#include <limits>

namespace glimmer {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr uint64_t kLargestBatch = 64;
constexpr double kTileSeconds = 0.25; // a tile of a batch should take no longer: cancel and the display wait for it
constexpr uint64_t kDefaultSamples = 64;

// Stratified sample sets of the film and the lens; the integrators' begin at 2.
enum Set : uint32_t { kSetPixel = 0, kSetLens = 1 };

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

uint64_t thread_cpu_nanoseconds() {
    timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return uint64_t(t.tv_sec) * 1000000000u + uint64_t(t.tv_nsec);
}

/// Blender's threads run with denormals flushed to zero, and threads inherit that: it turns e^-100 black.
void keep_denormals() {
    _mm_setcsr(0x1f80);
}

float filter_offset(const FilmSettings &film, float u) {
    if (film.filter_inverse.empty())
        return u - 0.5f;
    const float x = u * float(film.filter_inverse.size() - 1);
    const size_t i = std::min(size_t(x), film.filter_inverse.size() - 2);
    const float f = x - float(i);
    return (film.filter_inverse[i] * (1 - f) + film.filter_inverse[i + 1] * f) * film.filter_width;
}

} // namespace

Session::Session(std::shared_ptr<const Scene> scene, const RenderSettings &settings)
    : scene_(std::move(scene)), settings_(settings),
      integrator_(make_integrator(settings.integrator, *scene_, settings.limits)),
      film_(scene_->film.crop_width, scene_->film.crop_height, settings.tile_size, settings.passes), error_{kNaN, kNaN,
                                                                                                            kNaN},
      dirty_(film_.tiles().size(), false) {
    if (!settings_.samples && settings_.seconds <= 0 && settings_.target_error <= 0)
        settings_.samples = kDefaultSamples;
    if (!settings_.threads)
        settings_.threads = std::max(std::thread::hardware_concurrency(), 1u);
}

Session::~Session() {
    cancel();
    for (std::thread &worker : workers_)
        worker.join();
}

void Session::start() {
    const std::unique_lock lock(mutex_);
    if (state_ != GLIMMER_READY)
        fail_state("the render was started before");
    state_ = GLIMMER_RUNNING;
    running_since_ = now();
    plan_batch();
    if (state_ != GLIMMER_RUNNING)
        return;
    alive_ = settings_.threads;
    for (uint32_t i = 0; i < settings_.threads; ++i)
        workers_.emplace_back([this] { work(); });
}

void Session::pause() {
    std::unique_lock lock(mutex_);
    if (state_ != GLIMMER_RUNNING)
        return;
    state_ = GLIMMER_PAUSED;
    earlier_seconds_ += now() - running_since_;
    changed_.wait(lock, [this] { return busy_ == 0 && !between_batches_; });
}

void Session::resume() {
    const std::unique_lock lock(mutex_);
    if (state_ != GLIMMER_PAUSED)
        return;
    state_ = GLIMMER_RUNNING;
    running_since_ = now();
    changed_.notify_all();
}

void Session::cancel() {
    const std::unique_lock lock(mutex_);
    if (state_ == GLIMMER_READY || state_ == GLIMMER_RUNNING || state_ == GLIMMER_PAUSED)
        finish(GLIMMER_CANCELLED);
}

bool Session::wait(double seconds) {
    std::unique_lock lock(mutex_);
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
        earlier_seconds_ += now() - running_since_;
    state_ = state;
    stop_ = true;
    changed_.notify_all();
}

double Session::elapsed() const {
    return earlier_seconds_ + (state_ == GLIMMER_RUNNING ? now() - running_since_ : 0);
}

/// The next batch: as many passes as there were so far, so that the picture can be judged at every doubling; fewer
/// where a tile would take too long.
void Session::plan_batch() {
    samples_ = film_.min_samples();
    if (settings_.samples && samples_ >= settings_.samples)
        return finish(GLIMMER_FINISHED);
    uint64_t doubling = 1;
    while (doubling <= samples_)
        doubling *= 2;
    uint64_t count = std::min(doubling - samples_, kLargestBatch);
    if (slowest_tile_ > 0)
        count = std::min(count, std::max<uint64_t>(uint64_t(kTileSeconds / slowest_tile_), 1));
    if (settings_.samples)
        count = std::min(count, settings_.samples - samples_);
    batch_ = {samples_, count, 0, 0};
}

void Session::work() {
    keep_denormals();
    std::unique_lock lock(mutex_);
    const size_t tiles = film_.tiles().size();
    while (state_ == GLIMMER_RUNNING || state_ == GLIMMER_PAUSED) {
        if (state_ == GLIMMER_PAUSED || between_batches_ || batch_.next_tile == tiles) {
            changed_.wait(lock);
            continue;
        }
        take_tile(batch_.next_tile++, lock);
        changed_.notify_all();
    }
    // The last one out draws the last point of the curve, of whatever was finished; a cancel does not wait for it.
    if (alive_ == 1 && state_ == GLIMMER_FINISHED)
        add_curve_point(film_.min_samples(), lock);
    --alive_;
    changed_.notify_all();
}

/// Renders what the batch still wants of a tile; called with the lock held, which is let go meanwhile.
void Session::take_tile(size_t tile, std::unique_lock<std::mutex> &lock) {
    const uint64_t first = film_.tile_samples(tile), end = batch_.first + batch_.count;
    // The first batch is always finished: a picture with holes is none.
    const double deadline =
        settings_.seconds > 0 && first > 0 ? running_since_ + settings_.seconds - earlier_seconds_ : HUGE_VAL;
    ++busy_;
    lock.unlock();
    RayCounter rays;
    bool whole = first >= end; // a resumed batch may have been ahead here
    std::exception_ptr failure;
    const double start = now();
    const uint64_t cpu_start = thread_cpu_nanoseconds();
    try {
        whole = whole || render_tile(tile, first, end, deadline, rays);
    } catch (...) {
        failure = std::current_exception();
    }
    const double seconds = now() - start;
    cpu_nanoseconds_ += thread_cpu_nanoseconds() - cpu_start;
    rays_ += rays.rays;
    lock.lock();
    --busy_;
    if (failure) {
        if (!failure_)
            failure_ = failure;
        finish(GLIMMER_FAILED);
        return;
    }
    if (!whole) {
        if (state_ == GLIMMER_RUNNING)
            finish(GLIMMER_FINISHED); // only the time limit breaks a tile off while running
        return;
    }
    if (first < end)
        slowest_tile_ = std::max(slowest_tile_, seconds / double(end - first));
    if (!dirty_[tile]) {
        dirty_[tile] = true;
        dirty_order_.push_back(tile);
    }
    ++version_;
    if (++batch_.done_tiles == film_.tiles().size())
        end_batch(lock);
}

void Session::add_curve_point(uint64_t samples, std::unique_lock<std::mutex> &lock) {
    if (!curve_.empty() && curve_.back().samples == samples)
        return;
    between_batches_ = true;
    lock.unlock();
    const ErrorEstimate error = estimate_error(film_);
    lock.lock();
    between_batches_ = false;
    error_ = error;
    curve_.push_back({elapsed(), earlier_cpu_seconds_ + double(cpu_nanoseconds_) * 1e-9, samples, error});
}

/// Called by the worker that finished the batch's last tile, with the lock held; the others wait meanwhile.
void Session::end_batch(std::unique_lock<std::mutex> &lock) {
    const uint64_t samples = batch_.first + batch_.count;
    between_batches_ = true;
    if ((samples & (samples - 1)) == 0 || samples == settings_.samples)
        add_curve_point(samples, lock);
    if (state_ == GLIMMER_RUNNING || state_ == GLIMMER_PAUSED) {
        const bool met = settings_.target_error > 0 && error_.high <= settings_.target_error;
        const bool late = settings_.seconds > 0 && elapsed() >= settings_.seconds;
        if (met || late)
            finish(GLIMMER_FINISHED);
        else
            plan_batch();
    }
    slowest_tile_ = 0;
    between_batches_ = false;
}

bool Session::render_tile(size_t index, uint64_t first, uint64_t end, double deadline, RayCounter &rays) {
    const Rectangle &area = film_.tiles()[index];
    const FilmSettings &settings = scene_->film;
    Film::Tile tile(film_, index);
    std::vector<InvalidSample> invalid;
    for (uint32_t y = 0; y < area.height; ++y)
        for (uint32_t x = 0; x < area.width; ++x) {
            if (stop_.load(std::memory_order_relaxed) || (x % 16 == 0 && now() > deadline))
                return false;
            const uint32_t px = settings.crop_x + area.x + x, py = settings.crop_y + area.y + y;
            for (uint64_t s = first; s < end; ++s) {
                Sampler sampler(settings_.seed, px, py, uint32_t(s % kReplicates), uint32_t(s / kReplicates));
                const Vec2f u = sampler.stratified_2d(kSetPixel);
                const Vec2f film{(float(px) + 0.5f + filter_offset(settings, u.x)) / float(settings.width),
                                 (float(py) + 0.5f + filter_offset(settings, u.y)) / float(settings.height)};
                const Vec2f lens =
                    scene_->camera.lens_radius > 0 ? sample_uniform_disk(sampler.stratified_2d(kSetLens)) : Vec2f{};
                const FilmSample value = integrator_->sample(scene_->camera.generate(film, lens), sampler, rays);
                if (is_finite(value.radiance()))
                    tile.add(x, y, s, value);
                else
                    invalid.push_back({px, py, s});
            }
        }
    tile.commit(end);
    if (!invalid.empty()) {
        const std::lock_guard lock(mutex_);
        invalid_count_ += invalid.size();
        if (invalid_.empty())
            invalid_.push_back(invalid.front());
    }
    return true;
}

glimmer_progress Session::progress() {
    const std::lock_guard lock(mutex_);
    glimmer_progress p{};
    p.struct_size = sizeof p;
    p.state = state_;
    p.samples = film_.min_samples();
    p.seconds = elapsed();
    p.cpu_seconds = earlier_cpu_seconds_ + double(cpu_nanoseconds_) * 1e-9;
    double fraction = 0;
    if (settings_.samples) {
        const double within = double(batch_.count) * double(batch_.done_tiles) / double(film_.tiles().size());
        fraction = std::min((double(batch_.first) + within) / double(settings_.samples), 1.0);
    }
    if (settings_.seconds > 0)
        fraction = std::max(fraction, std::min(p.seconds / settings_.seconds, 1.0));
    if (settings_.target_error > 0 && error_.high > 0) // the error falls as 1 / time
        fraction = std::max(fraction, std::min(settings_.target_error / error_.high, 1.0));
    p.fraction = state_ == GLIMMER_FINISHED ? 1 : fraction;
    p.seconds_left = p.fraction > 0 ? p.seconds * (1 - p.fraction) / p.fraction : -1;
    p.relmse = error_.relmse;
    p.relmse_low = error_.low;
    p.relmse_high = error_.high;
    p.rays = rays_;
    p.peak_bytes = film_.bytes() + scene_->bytes();
    p.invalid_samples = invalid_count_;
    p.version = version_;
    return p;
}

bool Session::next_tile(glimmer_tile &tile) {
    const std::lock_guard lock(mutex_);
    if (dirty_order_.empty())
        return false;
    const size_t i = dirty_order_.front();
    dirty_order_.pop_front();
    dirty_[i] = false;
    const Rectangle &r = film_.tiles()[i];
    tile = {r.x, r.y, r.width, r.height, film_.tile_samples(i)};
    return true;
}

} // namespace glimmer
