// SPDX-License-Identifier: GPL-3.0-or-later
#include "film/film.h"

#include "base/bytes.h"
#include "base/error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace glimmer {

namespace {

constexpr float kNoDepth = 1e10f;

bool kept_as_sum(uint32_t pass) {
    return pass != GLIMMER_PASS_COMBINED && pass != GLIMMER_PASS_STDERR && pass != GLIMMER_PASS_SAMPLE_COUNT;
}

bool is_index(uint32_t pass) {
    return pass == GLIMMER_PASS_OBJECT_INDEX || pass == GLIMMER_PASS_MATERIAL_INDEX;
}

void add_rgb(std::vector<float> &sums, size_t pixel, const Rgb &value, float weight) {
    if (sums.empty())
        return;
    sums[3 * pixel] += value.r * weight;
    sums[3 * pixel + 1] += value.g * weight;
    sums[3 * pixel + 2] += value.b * weight;
}

} // namespace

PixelEstimate estimate_pixel(const Replicates &sums, uint64_t n) {
    PixelEstimate e;
    const auto used = uint32_t(std::min<uint64_t>(n, kReplicates));
    for (int c = 0; c < 3; ++c) {
        double total = 0;
        for (uint32_t r = 0; r < used; ++r)
            total += double(sums[r][c]);
        const double mean = n ? total / double(n) : 0;
        e.mean[c] = float(mean);
        if (used < 2) {
            e.standard_error[c] = std::numeric_limits<float>::quiet_NaN();
            continue;
        }
        double spread = 0;
        for (uint32_t r = 0; r < used; ++r) {
            const double count = double(replicate_samples(n, r)), d = double(sums[r][c]) / count - mean;
            spread += count * d * d;
        }
        e.standard_error[c] = float(std::sqrt(spread / (double(used - 1) * double(n))));
    }
    return e;
}

Film::Film(uint32_t width, uint32_t height, uint32_t tile_size, uint32_t passes, bool adaptive)
    : width_(width), height_(height), tile_size_(tile_size), tile_columns_((width + tile_size - 1) / tile_size),
      passes_(passes) {
    const uint32_t rows = (height + tile_size - 1) / tile_size;
    const size_t cells = size_t(tile_columns_) * rows;
    std::vector<uint32_t> order(cells);
    std::iota(order.begin(), order.end(), 0u);
    const auto cell = [&](uint32_t i) {
        const uint32_t x = i % tile_columns_ * tile_size, y = i / tile_columns_ * tile_size;
        return Rectangle{x, y, std::min(tile_size, width - x), std::min(tile_size, height - y)};
    };
    const auto off_center = [&](uint32_t i) {
        const Rectangle r = cell(i);
        const double dx = r.x + 0.5 * r.width - 0.5 * width, dy = r.y + 0.5 * r.height - 0.5 * height;
        return dx * dx + dy * dy;
    };
    std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return off_center(a) < off_center(b); });
    tile_of_cell_.resize(cells);
    for (uint32_t i : order) {
        tile_of_cell_[i] = uint32_t(tiles_.size());
        tiles_.push_back(cell(i));
    }
    tile_samples_ = std::make_unique<std::atomic<uint64_t>[]>(cells);
    tile_locks_ = std::make_unique<std::mutex[]>(cells);

    const size_t pixels = size_t(width) * height;
    radiance_.resize(pixels);
    for (uint32_t p = 0; p < GLIMMER_PASS_COUNT; ++p)
        if (kept_as_sum(p) && (passes & (1u << p)))
            sums_[p].assign(pixels * pass_channels(glimmer_pass(p)), 0.0f);
    if (passes & (1u << GLIMMER_PASS_DEPTH))
        hits_.assign(pixels, 0.0f);
    if (adaptive)
        plan_.resize(pixels);
}

size_t Film::bytes() const {
    size_t n = radiance_.size() * sizeof(Replicates) + hits_.size() * sizeof(float) + plan_.size() * sizeof(PixelPlan);
    for (const auto &s : sums_)
        n += s.size() * sizeof(float);
    return n;
}

size_t Film::tile_at(uint32_t x, uint32_t y) const {
    return tile_of_cell_[size_t(y / tile_size_) * tile_columns_ + x / tile_size_];
}

uint64_t Film::pixel_samples(uint32_t x, uint32_t y) const {
    return tile_samples(tile_at(x, y));
}

uint64_t Film::min_samples() const {
    uint64_t least = std::numeric_limits<uint64_t>::max();
    for (size_t i = 0; i < tiles_.size(); ++i)
        least = std::min(least, tile_samples(i));
    return least;
}

void Film::set_plan(const std::vector<PixelPlan> &plan) {
    for (size_t i = 0; i < tiles_.size(); ++i) {
        const std::lock_guard lock(tile_locks_[i]); // a reader may be at work
        const Rectangle &tile = tiles_[i];
        for (uint32_t y = tile.y; y < tile.y + tile.height; ++y) {
            const auto row = ptrdiff_t(size_t(y) * width_ + tile.x);
            std::copy_n(plan.begin() + row, tile.width, plan_.begin() + row);
        }
    }
    planned_ = true;
}

uint64_t Film::taken(size_t pixel, uint32_t r, uint64_t n) const {
    const uint64_t passes = replicate_samples(n, r);
    return plan_.empty() ? passes : plan_[pixel].taken(r, passes, pixel);
}

uint64_t Film::taken(size_t pixel, uint64_t n) const {
    if (plan_.empty())
        return n;
    uint64_t sum = 0;
    for (uint32_t r = 0; r < kReplicates; ++r)
        sum += taken(pixel, r, n);
    return sum;
}

float Film::covered(size_t pixel, uint64_t n) const {
    if (plan_.empty() || n <= kPlanPasses)
        return float(n);
    float sum = float(kPlanPasses);
    for (uint32_t r = 0; r < kReplicates; ++r)
        sum += float(taken(pixel, r, n) - kPlanPasses / kReplicates) * plan_[pixel].cover(r);
    return sum;
}

Replicates Film::at_one_a_pass(size_t pixel, uint64_t n) const {
    Replicates sums = radiance_[pixel];
    if (!plan_.empty() && n > kPlanPasses)
        for (uint32_t r = 0; r < kReplicates; ++r)
            sums[r] *= float(replicate_samples(n, r)) / float(taken(pixel, r, n));
    return sums;
}

SampleRange Film::samples_of_pass(size_t pixel, uint64_t pass) const {
    const auto r = uint32_t(pass % kReplicates);
    const uint64_t first = taken(pixel, r, pass);
    return {first, taken(pixel, r, pass + 1) - first};
}

std::array<uint64_t, 2> Film::samples_taken() const {
    std::array<uint64_t, 2> result{std::numeric_limits<uint64_t>::max(), 0};
    for (size_t i = 0; i < tiles_.size(); ++i) {
        const Rectangle &tile = tiles_[i];
        const std::lock_guard lock(tile_locks_[i]);
        const uint64_t n = tile_samples(i);
        for (uint32_t y = tile.y; y < tile.y + tile.height; ++y)
            for (uint32_t x = tile.x; x < tile.x + tile.width; ++x) {
                const uint64_t count = taken(size_t(y) * width_ + x, n);
                result = {std::min(result[0], count), std::max(result[1], count)};
            }
    }
    return result;
}

void Film::read(glimmer_pass pass, const Rectangle &where, float *pixels) const {
    const size_t channels = pass_channels(pass);
    const std::vector<float> &sums = sums_[size_t(pass)];
    // Tile by tile, so that each is locked once.
    for (size_t i = 0; i < tiles_.size(); ++i) {
        const Rectangle &tile = tiles_[i];
        const uint32_t x0 = std::max(tile.x, where.x), x1 = std::min(tile.x + tile.width, where.x + where.width);
        const uint32_t y0 = std::max(tile.y, where.y), y1 = std::min(tile.y + tile.height, where.y + where.height);
        if (x0 >= x1 || y0 >= y1)
            continue;
        const std::lock_guard lock(tile_locks_[i]);
        const uint64_t n = tile_samples(i);
        for (uint32_t y = y0; y < y1; ++y)
            for (uint32_t x = x0; x < x1; ++x) {
                float *out = pixels + ((size_t(y - where.y) * where.width) + (x - where.x)) * channels;
                const size_t pixel = size_t(y) * width_ + x;
                const float passes = covered(pixel, n), inverse = passes > 0 ? 1.0f / passes : 0.0f;
                switch (pass) {
                case GLIMMER_PASS_COMBINED: {
                    const Rgb mean = estimate_pixel(at_one_a_pass(pixel, n), n).mean;
                    out[0] = mean.r, out[1] = mean.g, out[2] = mean.b;
                    break;
                }
                case GLIMMER_PASS_STDERR: {
                    const Rgb error = estimate_pixel(at_one_a_pass(pixel, n), n).standard_error;
                    out[0] = error.r, out[1] = error.g, out[2] = error.b;
                    break;
                }
                case GLIMMER_PASS_SAMPLE_COUNT:
                    out[0] = float(taken(pixel, n));
                    break;
                case GLIMMER_PASS_DEPTH:
                    out[0] = hits_[pixel] > 0 ? sums[pixel] / hits_[pixel] : kNoDepth;
                    break;
                default:
                    for (size_t c = 0; c < channels; ++c)
                        out[c] = sums[pixel * channels + c] * (is_index(pass) ? 1.0f : inverse);
                }
            }
    }
}

void Film::save(std::vector<uint8_t> &out) const {
    const uint32_t head[4] = {width_, height_, tile_size_, passes_};
    append(out, head, 4);
    for (size_t i = 0; i < tiles_.size(); ++i) {
        const uint64_t n = tile_samples(i);
        append(out, &n, 1);
    }
    append(out, radiance_.data(), radiance_.size());
    for (const auto &s : sums_)
        append(out, s.data(), s.size());
    append(out, hits_.data(), hits_.size());
    append(out, plan_.data(), plan_.size());
    const uint64_t planned = planned_;
    append(out, &planned, 1);
}

void Film::load(const uint8_t *&data, const uint8_t *end) {
    uint32_t head[4];
    take(data, end, head, 4);
    if (head[0] != width_ || head[1] != height_ || head[2] != tile_size_ || head[3] != passes_)
        fail_argument("the saved state is of another picture size, tile size or set of passes");
    if (size_t(end - data) != (tiles_.size() + 1) * sizeof(uint64_t) + bytes())
        fail_argument("the saved state is damaged or ends too early");
    for (size_t i = 0; i < tiles_.size(); ++i) {
        uint64_t n;
        take(data, end, &n, 1);
        tile_samples_[i].store(n, std::memory_order_release);
    }
    take(data, end, radiance_.data(), radiance_.size());
    for (auto &s : sums_)
        take(data, end, s.data(), s.size());
    take(data, end, hits_.data(), hits_.size());
    take(data, end, plan_.data(), plan_.size());
    uint64_t planned;
    take(data, end, &planned, 1);
    planned_ = planned != 0;
}

Film::Tile::Tile(Film &film, size_t index) : film_(film), index_(index), area_(film.tiles_[index]) {
    const size_t pixels = size_t(area_.width) * area_.height;
    radiance_.resize(pixels);
    for (uint32_t p = 0; p < GLIMMER_PASS_COUNT; ++p)
        if (!film_.sums_[p].empty())
            sums_[p].resize(pixels * pass_channels(glimmer_pass(p)));
    if (!film_.hits_.empty())
        hits_.resize(pixels);
    copy(false);
}

void Film::Tile::copy(bool put_back) {
    const auto rows = [&](auto &whole, auto &part, size_t channels) {
        if (part.empty())
            return;
        for (uint32_t y = 0; y < area_.height; ++y) {
            auto *w = whole.data() + (size_t(area_.y + y) * film_.width_ + area_.x) * channels;
            auto *p = part.data() + size_t(y) * area_.width * channels;
            const size_t count = area_.width * channels;
            put_back ? std::copy_n(p, count, w) : std::copy_n(w, count, p);
        }
    };
    rows(film_.radiance_, radiance_, 1);
    for (uint32_t p = 0; p < GLIMMER_PASS_COUNT; ++p)
        rows(film_.sums_[p], sums_[p], pass_channels(glimmer_pass(p)));
    rows(film_.hits_, hits_, 1);
}

SampleRange Film::Tile::samples_of_pass(uint32_t x, uint32_t y, uint64_t pass) const {
    return film_.samples_of_pass(size_t(area_.y + y) * film_.width_ + area_.x + x, pass);
}

void Film::Tile::add(uint32_t x, uint32_t y, uint64_t pass, const FilmSample &value) {
    const size_t pixel = size_t(y) * area_.width + x;
    const auto r = uint32_t(pass % kReplicates);
    // The radiance is divided by what was taken in the end; all else, which is kept in one sum, by the passes that the
    // samples stand for.
    const bool by_plan = film_.planned_ && pass >= kPlanPasses;
    const float weight = by_plan ? film_.plan_[size_t(area_.y + y) * film_.width_ + area_.x + x].cover(r) : 1.0f;
    radiance_[pixel][r] += value.radiance();
    add_rgb(sums_[GLIMMER_PASS_ALBEDO], pixel, value.albedo, weight);
    add_rgb(sums_[GLIMMER_PASS_NORMAL], pixel, {value.normal.x, value.normal.y, value.normal.z}, weight);
    add_rgb(sums_[GLIMMER_PASS_EMISSION], pixel, value.emission, weight);
    add_rgb(sums_[GLIMMER_PASS_DIRECT], pixel, value.direct, weight);
    add_rgb(sums_[GLIMMER_PASS_INDIRECT], pixel, value.indirect, weight);
    add_rgb(sums_[GLIMMER_PASS_FOG], pixel, value.medium, weight);
    if (value.hit && !hits_.empty()) {
        sums_[GLIMMER_PASS_DEPTH][pixel] += value.depth * weight;
        hits_[pixel] += weight;
    }
    if (pass == 0) {
        if (!sums_[GLIMMER_PASS_OBJECT_INDEX].empty())
            sums_[GLIMMER_PASS_OBJECT_INDEX][pixel] = float(value.object_index);
        if (!sums_[GLIMMER_PASS_MATERIAL_INDEX].empty())
            sums_[GLIMMER_PASS_MATERIAL_INDEX][pixel] = float(value.material_index);
    }
}

void Film::Tile::commit(uint64_t samples) {
    const std::lock_guard lock(film_.tile_locks_[index_]);
    copy(true);
    film_.tile_samples_[index_].store(samples, std::memory_order_release);
}

} // namespace glimmer
