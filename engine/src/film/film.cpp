// SPDX-License-Identifier: GPL-3.0-or-later
#include "film/film.h"

#include "base/bytes.h"
#include "base/error.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>

namespace glimmer {

namespace {

/// Whether the film keeps one sum over all samples of the pass; it makes the others from the replicates.
bool is_kept_as_sum(uint32_t pass) {
    return kPasses[pass].value != nullptr;
}

} // namespace

Film::Film(uint32_t width, uint32_t height, uint32_t tile_size, uint64_t passes, bool adaptive)
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
        if (is_kept_as_sum(p) && (passes & bit_of(p)))
            sums_[p].assign(pixels * pass_channels(glimmer_pass(p)), 0.0f);
    if (passes & bit_of(GLIMMER_PASS_DEPTH))
        hits_.assign(pixels, 0.0f);
    if (adaptive)
        allocation_.resize(pixels);
}

size_t Film::bytes() const {
    size_t n = radiance_.size() * sizeof(Replicates) + hits_.size() * sizeof(float) +
               allocation_.size() * sizeof(PixelAllocation);
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

void Film::set_allocation(const std::vector<PixelAllocation> &allocation) {
    for (size_t i = 0; i < tiles_.size(); ++i) {
        const std::lock_guard lock(tile_locks_[i]); // a reader may be at work
        const Rectangle &tile = tiles_[i];
        for (uint32_t y = tile.y; y < tile.y + tile.height; ++y) {
            const auto row = ptrdiff_t(size_t(y) * width_ + tile.x);
            std::copy_n(allocation.begin() + row, tile.width, allocation_.begin() + row);
        }
    }
    allocated_ = true;
}

uint64_t Film::taken(size_t pixel, uint32_t r, uint64_t n) const {
    const uint64_t waves = replicate_samples(n, r);
    return allocation_.empty() ? waves : allocation_[pixel].taken(r, waves, pixel);
}

uint64_t Film::taken(size_t pixel, uint64_t n) const {
    if (allocation_.empty())
        return n;
    uint64_t sum = 0;
    for (uint32_t r = 0; r < kReplicates; ++r)
        sum += taken(pixel, r, n);
    return sum;
}

float Film::covered(size_t pixel, uint64_t n) const {
    if (allocation_.empty() || n <= kUniformWaves)
        return float(n);
    float sum = float(kUniformWaves);
    for (uint32_t r = 0; r < kReplicates; ++r)
        sum += float(taken(pixel, r, n) - kUniformWaves / kReplicates) * allocation_[pixel].waves_a_sample(r);
    return sum;
}

Replicates Film::at_one_a_wave(size_t pixel, uint64_t n) const {
    Replicates sums = radiance_[pixel];
    if (!allocation_.empty() && n > kUniformWaves)
        for (uint32_t r = 0; r < kReplicates; ++r)
            sums[r] *= float(replicate_samples(n, r)) / float(taken(pixel, r, n));
    return sums;
}

SampleRange Film::samples_of_wave(size_t pixel, uint64_t wave) const {
    const auto r = uint32_t(wave % kReplicates);
    const uint64_t first = taken(pixel, r, wave);
    return {first, taken(pixel, r, wave + 1) - first};
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
                read_pixel(pass, pixel, n, out);
            }
    }
}

void Film::read_pixel(glimmer_pass pass, size_t pixel, uint64_t n, float *out) const {
    const size_t channels = pass_channels(pass);
    const float *sums = is_kept_as_sum(pass) ? sums_[size_t(pass)].data() + pixel * channels : nullptr;
    const auto write = [&](const Rgb &value) { out[0] = value.r, out[1] = value.g, out[2] = value.b; };
    switch (kPasses[size_t(pass)].info.rule) {
    case GLIMMER_RULE_STANDARD_ERROR:
        return write(estimate_pixel(at_one_a_wave(pixel, n), n).standard_error);
    case GLIMMER_RULE_COUNT:
        out[0] = float(taken(pixel, n));
        return;
    case GLIMMER_RULE_MEAN_OF_HITS:
        out[0] = hits_[pixel] > 0 ? sums[0] / hits_[pixel] : GLIMMER_NO_DEPTH;
        return;
    case GLIMMER_RULE_FIRST:
        std::copy_n(sums, channels, out);
        return;
    case GLIMMER_RULE_MATTE: {
        std::array<std::pair<float, float>, GLIMMER_MATTE_RANKS> ranks;
        const float waves = covered(pixel, n), inverse = waves > 0 ? 1.0f / waves : 0.0f;
        for (size_t i = 0; i < ranks.size(); ++i)
            ranks[i] = {sums[2 * i], sums[2 * i + 1] * inverse};
        std::ranges::stable_sort(ranks, std::greater(), &std::pair<float, float>::second);
        for (size_t i = 0; i < ranks.size(); ++i)
            out[2 * i] = ranks[i].first, out[2 * i + 1] = ranks[i].second;
        return;
    }
    case GLIMMER_RULE_MEAN: {
        if (!sums)
            return write(estimate_pixel(at_one_a_wave(pixel, n), n).mean);
        const float waves = covered(pixel, n), inverse = waves > 0 ? 1.0f / waves : 0.0f;
        for (size_t c = 0; c < channels; ++c)
            out[c] = sums[c] * inverse;
    }
    }
}

void Film::save(std::vector<uint8_t> &out) const {
    const uint64_t head[4] = {width_, height_, tile_size_, passes_};
    append(out, head, 4);
    for (size_t i = 0; i < tiles_.size(); ++i) {
        const uint64_t n = tile_samples(i);
        append(out, &n, 1);
    }
    append(out, radiance_.data(), radiance_.size());
    for (const auto &s : sums_)
        append(out, s.data(), s.size());
    append(out, hits_.data(), hits_.size());
    append(out, allocation_.data(), allocation_.size());
    const uint64_t planned = allocated_;
    append(out, &planned, 1);
}

void Film::load(const uint8_t *&data, const uint8_t *end) {
    uint64_t head[4];
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
    take(data, end, allocation_.data(), allocation_.size());
    uint64_t planned;
    take(data, end, &planned, 1);
    allocated_ = planned != 0;
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

SampleRange Film::Tile::samples_of_wave(uint32_t x, uint32_t y, uint64_t wave) const {
    return film_.samples_of_wave(size_t(area_.y + y) * film_.width_ + area_.x + x, wave);
}

void Film::Tile::add(uint32_t x, uint32_t y, uint64_t wave, const FilmSample &sample) {
    const size_t pixel = size_t(y) * area_.width + x;
    const auto r = uint32_t(wave % kReplicates);
    // The radiance is divided by the samples that were taken in the end. All else is kept in one sum and divided by the
    // waves that its samples stand for.
    const bool by_allocation = film_.allocated_ && wave >= kUniformWaves;
    const float weight =
        by_allocation ? film_.allocation_[size_t(area_.y + y) * film_.width_ + area_.x + x].waves_a_sample(r) : 1.0f;
    radiance_[pixel][r] += sample.radiance();
    for (uint32_t p = 0; p < GLIMMER_PASS_COUNT; ++p)
        if (!sums_[p].empty())
            add_to_pass(glimmer_pass(p), pixel, wave, sample, weight);
    if (sample.hit && !hits_.empty())
        hits_[pixel] += weight;
}

void Film::Tile::add_to_pass(glimmer_pass pass, size_t pixel, uint64_t wave, const FilmSample &sample, float weight) {
    const glimmer_pass_rule rule = kPasses[size_t(pass)].info.rule;
    const size_t channels = pass_channels(pass);
    float *sums = sums_[size_t(pass)].data() + pixel * channels;
    if (rule == GLIMMER_RULE_MATTE)
        return add_covers(*sample.more, pass == GLIMMER_PASS_OBJECT_MATTE ? &Cover::object : &Cover::material, weight,
                          sums);
    std::array<float, detail::kMaxPassChannels> value;
    kPasses[size_t(pass)].value(sample, value.data());
    if (rule == GLIMMER_RULE_FIRST) {
        if (wave == 0)
            std::copy_n(value.data(), channels, sums);
    } else if (rule == GLIMMER_RULE_MEAN || sample.hit) {
        for (size_t c = 0; c < channels; ++c)
            sums[c] += value[c] * weight;
    }
}

void Film::Tile::add_covers(const PassSample &sample, uint32_t Cover::*number, float weight, float *pairs) {
    for (uint32_t i = 0; i < sample.cover_count; ++i) {
        const auto of = float(sample.covers[i].*number);
        // Where there are too many, the last pair stands for all the rest.
        uint32_t rank = 0;
        while (rank + 1 < GLIMMER_MATTE_RANKS && pairs[2 * rank] != of && pairs[2 * rank] != 0)
            ++rank;
        if (of == 0)
            continue;
        if (pairs[2 * rank] == 0)
            pairs[2 * rank] = of;
        pairs[2 * rank + 1] += sample.covers[i].part * weight;
    }
}

void Film::Tile::commit(uint64_t samples) {
    const std::lock_guard lock(film_.tile_locks_[index_]);
    copy(true);
    film_.tile_samples_[index_].store(samples, std::memory_order_release);
}

} // namespace glimmer
