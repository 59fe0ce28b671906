// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/session.h"

#include "base/error.h"
#include "camera/camera_sample.h"
#include "sampling/dimensions.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <immintrin.h>
#include <limits>
#include <system_error>

namespace glimmer {

namespace {

constexpr uint64_t kLargestBatch = 64;
constexpr uint64_t kLargestSharedBatch = 16; // what passes share is kept for the batch
constexpr double kTileSeconds = 0.25; // a tile of a batch should take no longer: cancel and the display wait for it
constexpr uint64_t kDefaultSamples = 64;

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

} // namespace

Session::Session(std::shared_ptr<const Scene> scene, const RenderSettings &settings)
    : scene_(std::move(scene)), settings_(settings),
      integrator_(make_integrator(settings.integrator, *scene_, settings.limits, settings.full_kernel)),
      film_(scene_->film.crop_width, scene_->film.crop_height, settings.tile_size, settings.passes, settings.adaptive),
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
    std::unique_lock lock(mutex_);
    if (state_ != GLIMMER_READY)
        fail_state("the render was started before");
    state_ = GLIMMER_RUNNING;
    running_since_ = now();
    plan_film(lock);
    if (state_ == GLIMMER_RUNNING || state_ == GLIMMER_PAUSED)
        plan_batch();
    if (state_ != GLIMMER_RUNNING && state_ != GLIMMER_PAUSED)
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
    std::unique_lock lock(mutex_);
    if (state_ != GLIMMER_RUNNING)
        return;
    state_ = GLIMMER_PAUSED;
    earlier_seconds_ += now() - running_since_;
    changed_.wait(lock, [this] { return state_ != GLIMMER_PAUSED || (busy_ == 0 && !between_batches_); });
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
    if (state_ == GLIMMER_READY || state_ == GLIMMER_RUNNING || state_ == GLIMMER_PAUSED) {
        cancelled_ = true;
        finish(GLIMMER_CANCELLED);
    }
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

double Session::until(double then) const {
    return std::isfinite(then) ? std::max(then - elapsed(), 0.0) : -1;
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
    uint64_t count = std::min(doubling - samples_, integrator_->shares() ? kLargestSharedBatch : kLargestBatch);
    if (slowest_tile_ > 0)
        count = std::min(count, std::max<uint64_t>(uint64_t(kTileSeconds / slowest_tile_), 1));
    if (settings_.samples)
        count = std::min(count, settings_.samples - samples_);
    batch_ = {};
    batch_.first = samples_;
    batch_.count = count;
    if (integrator_->shares())
        batch_.passes.resize(count);
}

void Session::work() {
    keep_denormals();
    std::unique_lock lock(mutex_);
    const size_t tiles = film_.tiles().size();
    while (state_ == GLIMMER_RUNNING || state_ == GLIMMER_PAUSED) {
        const bool prepared = batch_.done_passes == batch_.passes.size();
        if (state_ == GLIMMER_RUNNING && !between_batches_ && batch_.next_pass < batch_.passes.size()) {
            take_pass(batch_.next_pass++, lock);
        } else if (state_ == GLIMMER_RUNNING && !between_batches_ && prepared && batch_.next_tile < tiles) {
            take_tile(batch_.next_tile++, lock);
        } else {
            changed_.wait(lock);
            continue; // nothing changed: two that woke each other here would keep a core busy
        }
        changed_.notify_all();
    }
    // The last one out draws the last point of the curve, of whatever was finished; a cancel does not wait for it.
    if (alive_ == 1 && state_ == GLIMMER_FINISHED)
        add_curve_point(film_.min_samples(), lock);
    --alive_;
    changed_.notify_all();
}

/// Prepares what the pixels of one pass share; called with the lock held, which is let go meanwhile.
void Session::take_pass(size_t index, std::unique_lock<std::mutex> &lock) {
    ++busy_;
    const uint64_t sample = batch_.first + index;
    lock.unlock();
    TraceContext rays{0, &stop_};
    std::unique_ptr<const WaveData> pass;
    std::exception_ptr failure;
    const uint64_t cpu_start = thread_cpu_nanoseconds();
    try {
        pass = integrator_->prepare_wave(settings_.seed, sample, stop_, rays);
    } catch (...) {
        failure = std::current_exception();
    }
    cpu_nanoseconds_ += thread_cpu_nanoseconds() - cpu_start;
    rays_ += rays.rays;
    lock.lock();
    --busy_;
    if (failure)
        return fail(failure);
    batch_.shared_bytes += pass->bytes();
    most_shared_bytes_ = std::max(most_shared_bytes_, batch_.shared_bytes);
    batch_.passes[index] = std::move(pass);
    ++batch_.done_passes;
}

void Session::fail(const std::exception_ptr &failure) {
    if (!failure_)
        failure_ = failure;
    finish(GLIMMER_FAILED);
}

/// Renders what the batch still wants of a tile; called with the lock held, which is let go meanwhile.
void Session::take_tile(size_t tile, std::unique_lock<std::mutex> &lock) {
    const uint64_t first = film_.tile_samples(tile), end = batch_.first + batch_.count;
    // The first batch is always finished: a picture with holes is none.
    const double deadline =
        settings_.seconds > 0 && first > 0 ? running_since_ + settings_.seconds - earlier_seconds_ : HUGE_VAL;
    ++busy_;
    lock.unlock();
    TraceContext rays{0, &stop_};
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
    if (failure)
        return fail(failure);
    if (!whole) {
        // Only the time limit breaks a tile off before the end; paused or not, the batch cannot be completed then.
        if (state_ == GLIMMER_RUNNING || state_ == GLIMMER_PAUSED)
            finish(GLIMMER_FINISHED);
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
    const auto looks =
        std::count_if(curve_.begin(), curve_.end(), [](const auto &p) { return p.error.has_interval(); });
    lock.unlock();
    const std::optional<ErrorEstimate> error = estimate_error(film_, uint32_t(looks) + 1, cancelled_);
    lock.lock();
    between_batches_ = false;
    if (!error)
        return;
    curve_.push_back({elapsed(), earlier_cpu_seconds_ + double(cpu_nanoseconds_) * 1e-9, samples, *error});
    judge_curve();
}

void Session::judge_curve() {
    error_ = curve_.empty() ? ErrorEstimate{} : curve_.back().error;
    rate_ = fit_rate(curve_);
    forecast_ = forecast(curve_, rate_, settings_.target_error);
}

/// Makes the plan of an adaptive film when it is time; called with the lock held, which is let go meanwhile.
void Session::plan_film(std::unique_lock<std::mutex> &lock) {
    if (!film_.adaptive() || film_.planned() || film_.min_samples() < kPlanPasses)
        return;
    between_batches_ = true;
    lock.unlock();
    const std::vector<PixelPlan> plan = plan_samples(film_, cancelled_);
    if (!plan.empty())
        film_.set_plan(plan);
    lock.lock();
    between_batches_ = false;
    changed_.notify_all();
}

/// Called by the worker that finished the batch's last tile, with the lock held; the others wait meanwhile.
void Session::end_batch(std::unique_lock<std::mutex> &lock) {
    const uint64_t samples = batch_.first + batch_.count;
    between_batches_ = true;
    if ((samples & (samples - 1)) == 0 || samples == settings_.samples)
        add_curve_point(samples, lock);
    if (state_ == GLIMMER_RUNNING || state_ == GLIMMER_PAUSED) {
        const bool met = !curve_.empty() && curve_.back().meets(settings_.target_error);
        const bool late = settings_.seconds > 0 && elapsed() >= settings_.seconds;
        if (met || late) {
            finish(GLIMMER_FINISHED);
        } else {
            plan_film(lock);
            if (state_ == GLIMMER_RUNNING || state_ == GLIMMER_PAUSED)
                plan_batch();
        }
    }
    slowest_tile_ = 0;
    between_batches_ = false;
}

bool Session::render_tile(size_t index, uint64_t first, uint64_t end, double deadline, TraceContext &rays) {
    const Rectangle &area = film_.tiles()[index];
    const FilmSettings &settings = scene_->film;
    Film::Tile tile(film_, index);
    std::vector<InvalidSample> invalid;
    uint64_t unfinished = 0;
    // Blocks are the integrator's; tiles are made of whole ones, so their size changes nothing.
    for (uint32_t by = 0; by < area.height; by += kBlockSize)
        for (uint32_t bx = 0; bx < area.width; bx += kBlockSize) {
            const Rectangle block{settings.crop_x + area.x + bx, settings.crop_y + area.y + by,
                                  std::min(kBlockSize, area.width - bx), std::min(kBlockSize, area.height - by)};
            for (uint64_t s = first; s < end; ++s) {
                std::unique_ptr<const BlockData> shared;
                for (uint32_t y = block.y; y < block.y + block.height; ++y)
                    for (uint32_t x = block.x; x < block.x + block.width; ++x) {
                        if (x % 16 == 0 && now() > deadline)
                            return false;
                        const uint32_t tile_x = x - settings.crop_x - area.x, tile_y = y - settings.crop_y - area.y;
                        const SampleRange samples = tile.samples_of_pass(tile_x, tile_y, s);
                        for (uint64_t i = samples.first; i < samples.first + samples.count; ++i) {
                            if (stop_.load(std::memory_order_relaxed))
                                return false;
                            if (!shared && !batch_.passes.empty())
                                shared = integrator_->prepare_block(*batch_.passes[s - batch_.first], block, rays);
                            Sampler sampler(settings_.seed, x, y, uint32_t(s % kReplicates), uint32_t(i));
                            const CameraRay camera =
                                sample_camera_ray(*scene_, x, y, sampler.stratified_2d(dimension(Dimension::film)),
                                                  sampler.stratified_2d(dimension(Dimension::lens)));
                            const FilmSample value = integrator_->sample(camera, sampler, shared.get(), rays);
                            if (value.unfinished && stop_.load(std::memory_order_relaxed))
                                return false;
                            unfinished += value.unfinished ? 1 : 0;
                            if (is_finite(value.radiance()))
                                tile.add(tile_x, tile_y, s, value);
                            else
                                invalid.push_back({x, y, s});
                        }
                    }
            }
        }
    tile.commit(end);
    if (unfinished || !invalid.empty()) {
        const std::lock_guard lock(mutex_);
        unfinished_count_ += unfinished;
        invalid_count_ += invalid.size();
        if (invalid_.empty() && !invalid.empty())
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
    p.seconds_to_half = until(forecast_.half);
    p.seconds_to_target = until(forecast_.target);
    if (forecast_.target > 0)
        fraction = std::max(fraction, std::min(p.seconds / forecast_.target, 1.0));
    p.fraction = state_ == GLIMMER_FINISHED ? 1 : fraction;
    p.seconds_left = p.fraction > 0 ? p.seconds * (1 - p.fraction) / p.fraction : -1;
    p.relmse = error_.relmse;
    p.relmse_low = error_.low;
    p.relmse_high = error_.high;
    p.heavy_tails = error_.has_interval() && !error_.certifiable();
    p.largest_share = error_.largest_share;
    p.largest_x = error_.x;
    p.largest_y = error_.y;
    p.rate = rate_.power;
    p.rate_low = rate_.low;
    p.rate_high = rate_.high;
    p.rays = rays_;
    p.peak_bytes = film_.bytes() + scene_->bytes + most_shared_bytes_;
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
