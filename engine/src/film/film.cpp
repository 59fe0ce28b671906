// SPDX-License-Identifier: GPL-3.0-or-later
#include "film/film.h"

#include "base/bytes.h"
#include "base/error.h"

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <utility>

namespace glimmer {

namespace {

/// Whether the film keeps one sum over all samples of the pass; it makes the others from the replicates.
bool is_kept_as_sum(uint32_t pass) {
    return kPasses[pass].value != nullptr;
}

} // namespace

Film::Film(uint32_t width, uint32_t height, uint32_t tile_size, uint64_t passes, bool adaptive, const FilmReach &reach)
    : width_(width), height_(height), tile_size_(tile_size), passes_(passes), layout_(width, height, tile_size, reach),
      tile_samples_(std::make_unique<std::atomic<uint64_t>[]>(layout_.tiles().size())),
      tile_locks_(std::make_unique<std::mutex[]>(layout_.tiles().size())), radiance_(layout_.slots()) {
    for (uint32_t p = 0; p < GLIMMER_PASS_COUNT; ++p)
        if (is_kept_as_sum(p) && (passes & bit_of(p)))
            sums_[p].assign(layout_.slots() * pass_channels(glimmer_pass(p)), 0.0f);
    if (passes & bit_of(GLIMMER_PASS_DEPTH))
        hits_.assign(layout_.slots(), 0.0f);
    if (adaptive)
        allocation_.resize(size_t(width) * height);
}

size_t Film::bytes() const {
    size_t n = radiance_.size() * sizeof(Replicates) + hits_.size() * sizeof(float) +
               allocation_.size() * sizeof(PixelAllocation);
    for (const auto &s : sums_)
        n += s.size() * sizeof(float);
    return n;
}

uint64_t Film::pixel_samples(uint32_t x, uint32_t y) const {
    return tile_samples(layout_.tile_at(x, y));
}

uint64_t Film::min_samples() const {
    uint64_t least = std::numeric_limits<uint64_t>::max();
    for (size_t i = 0; i < tiles().size(); ++i)
        least = std::min(least, tile_samples(i));
    return least;
}

std::vector<size_t> Film::tiles_changed_by(size_t tile) const {
    std::vector<size_t> result{tile};
    for (const size_t t : layout_.tiles_that_reach(tile))
        if (t != tile && tile_samples(t) > 0)
            result.push_back(t);
    return result;
}

void Film::set_allocation(const std::vector<PixelAllocation> &allocation) {
    for (size_t i = 0; i < tiles().size(); ++i) {
        const std::lock_guard lock(tile_locks_[i]); // a reader may be at work
        const Rectangle &tile = tiles()[i];
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

Replicates Film::replicates(uint32_t x, uint32_t y) const {
    const uint64_t n = pixel_samples(x, y);
    Replicates sums{};
    layout_.for_cells_at(x, y, [&](const Cell &cell) {
        const Replicates &part = radiance_[cell.slot(int32_t(x), int32_t(y))];
        const uint64_t m = tile_samples(cell.tile);
        if (!allocation_.empty() && n > kUniformWaves) {
            const size_t pixel = size_t(y) * width_ + x;
            for (uint32_t r = 0; r < kReplicates; ++r)
                sums[r] += part[r] * (float(replicate_samples(n, r)) / float(taken(pixel, r, n)));
        } else if (m == n) {
            for (uint32_t r = 0; r < kReplicates; ++r)
                sums[r] += part[r];
        } else if (m > 0) { // a neighbour that is ahead or behind
            Rgb all;
            for (const Rgb &sum : part)
                all += sum;
            for (uint32_t r = 0; r < kReplicates; ++r) {
                const auto own = float(replicate_samples(n, r)), there = float(replicate_samples(m, r));
                sums[r] += there > 0 ? part[r] * (own / there) : all * (own / float(m));
            }
        }
    });
    return sums;
}

SampleRange Film::samples_of_wave(size_t pixel, uint64_t wave) const {
    const auto r = uint32_t(wave % kReplicates);
    const uint64_t first = taken(pixel, r, wave);
    return {first, taken(pixel, r, wave + 1) - first};
}

std::array<uint64_t, 2> Film::samples_taken() const {
    std::array<uint64_t, 2> result{std::numeric_limits<uint64_t>::max(), 0};
    for (size_t i = 0; i < tiles().size(); ++i) {
        const Rectangle &tile = tiles()[i];
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
    for (size_t i = 0; i < tiles().size(); ++i) {
        const Rectangle &tile = tiles()[i];
        const uint32_t x0 = std::max(tile.x, where.x), x1 = std::min(tile.x + tile.width, where.x + where.width);
        const uint32_t y0 = std::max(tile.y, where.y), y1 = std::min(tile.y + tile.height, where.y + where.height);
        if (x0 >= x1 || y0 >= y1)
            continue;
        std::vector<std::unique_lock<std::mutex>> locks; // in ascending order, and a writer takes one alone
        for (const size_t t : layout_.tiles_that_reach(i))
            locks.emplace_back(tile_locks_[t]);
        for (uint32_t y = y0; y < y1; ++y)
            for (uint32_t x = x0; x < x1; ++x)
                read_pixel(pass, x, y, pixels + ((size_t(y - where.y) * where.width) + (x - where.x)) * channels);
    }
}

void Film::read_pixel(glimmer_pass pass, uint32_t x, uint32_t y, float *out) const {
    const size_t channels = pass_channels(pass), pixel = size_t(y) * width_ + x;
    const uint64_t n = pixel_samples(x, y);
    const std::vector<float> &sums = sums_[size_t(pass)];
    const auto slot = [&](const Cell &cell) { return cell.slot(int32_t(x), int32_t(y)); };
    const auto write = [&](const Rgb &value) { out[0] = value.r, out[1] = value.g, out[2] = value.b; };
    switch (kPasses[size_t(pass)].info.rule) {
    case GLIMMER_RULE_STANDARD_ERROR:
        return write(estimate_pixel(replicates(x, y), n).standard_error);
    case GLIMMER_RULE_COUNT:
        out[0] = float(taken(pixel, n));
        return;
    case GLIMMER_RULE_MEAN_OF_HITS: {
        float sum = 0, hits = 0;
        layout_.for_cells_at(x, y, [&](const Cell &cell) {
            const uint64_t m = tile_samples(cell.tile);
            const float scale = m == n || m == 0 ? 1.0f : float(n) / float(m);
            sum += sums[slot(cell)] * scale;
            hits += hits_[slot(cell)] * scale;
        });
        out[0] = hits > 0 ? sum / hits : GLIMMER_NO_DEPTH;
        return;
    }
    case GLIMMER_RULE_FIRST:
        return layout_.for_cells_at(x, y, [&](const Cell &cell) {
            if (cell.sampled.holds(int32_t(x), int32_t(y)))
                std::copy_n(sums.data() + slot(cell) * channels, channels, out);
        });
    case GLIMMER_RULE_MATTE:
        return read_matte(sums, x, y, out);
    case GLIMMER_RULE_MEAN: {
        if (!is_kept_as_sum(uint32_t(pass)))
            return write(estimate_pixel(replicates(x, y), n).mean);
        std::fill_n(out, channels, 0.0f);
        layout_.for_cells_at(x, y, [&](const Cell &cell) {
            const float waves = covered(pixel, tile_samples(cell.tile)), inverse = waves > 0 ? 1.0f / waves : 0.0f;
            for (size_t c = 0; c < channels; ++c)
                out[c] += sums[slot(cell) * channels + c] * inverse;
        });
    }
    }
}

void Film::read_matte(const std::vector<float> &sums, uint32_t x, uint32_t y, float *pairs) const {
    using Part = std::pair<float, float>; // a number and how much of the pixel it takes up
    std::array<Part, 4 * GLIMMER_MATTE_RANKS> parts;
    size_t count = 0;
    layout_.for_cells_at(x, y, [&](const Cell &cell) {
        const float *of_cell = sums.data() + cell.slot(int32_t(x), int32_t(y)) * 2 * GLIMMER_MATTE_RANKS;
        const float waves = covered(size_t(y) * width_ + x, tile_samples(cell.tile)),
                    inverse = waves > 0 ? 1.0f / waves : 0.0f;
        for (size_t i = 0; i < GLIMMER_MATTE_RANKS && of_cell[2 * i] != 0; ++i) {
            const auto end = parts.begin() + ptrdiff_t(count);
            const auto same = std::ranges::find(parts.begin(), end, of_cell[2 * i], &Part::first);
            if (same == end)
                parts[count++] = {of_cell[2 * i], 0.0f};
            same->second += of_cell[2 * i + 1] * inverse;
        }
    });
    std::ranges::stable_sort(parts.begin(), parts.begin() + ptrdiff_t(count), std::greater(), &Part::second);
    for (size_t i = GLIMMER_MATTE_RANKS; i < count; ++i) // where there are too many, the last stands for all the rest
        parts[GLIMMER_MATTE_RANKS - 1].second += parts[i].second;
    for (size_t i = 0; i < GLIMMER_MATTE_RANKS; ++i)
        pairs[2 * i] = parts[i].first, pairs[2 * i + 1] = parts[i].second;
}

void Film::save(std::vector<uint8_t> &out) const {
    const uint64_t head[5] = {width_, height_, tile_size_, passes_, reach()};
    append(out, head, 5);
    for (size_t i = 0; i < tiles().size(); ++i) {
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
    uint64_t head[5];
    take(data, end, head, 5);
    if (head[0] != width_ || head[1] != height_ || head[2] != tile_size_ || head[3] != passes_)
        fail_argument("the saved state is of another picture size, tile size or set of passes");
    if (head[4] != reach())
        fail_argument("the saved state is of a film whose samples count for other pixels: by another filter, or pixels "
                      "were independent");
    if (size_t(end - data) != (tiles().size() + 1) * sizeof(uint64_t) + bytes())
        fail_argument("the saved state is damaged or ends too early");
    for (size_t i = 0; i < tiles().size(); ++i) {
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

Film::Tile::Tile(Film &film, size_t index) : film_(film), index_(index), begin_(film.cells(index).front().begin) {
    const Cell &last = film.cells(index).back();
    size_ = last.begin + last.reached.pixels() - begin_;
    radiance_.resize(size_);
    for (uint32_t p = 0; p < GLIMMER_PASS_COUNT; ++p)
        if (!film_.sums_[p].empty())
            sums_[p].resize(size_ * pass_channels(glimmer_pass(p)));
    if (!film_.hits_.empty())
        hits_.resize(size_);
    copy(false);
}

void Film::Tile::copy(bool put_back) {
    const auto slots = [&](auto &whole, auto &part, size_t channels) {
        auto *of_film = whole.data() + begin_ * channels;
        put_back ? std::copy_n(part.data(), part.size(), of_film) : std::copy_n(of_film, part.size(), part.data());
    };
    slots(film_.radiance_, radiance_, 1);
    for (uint32_t p = 0; p < GLIMMER_PASS_COUNT; ++p)
        if (!sums_[p].empty())
            slots(film_.sums_[p], sums_[p], pass_channels(glimmer_pass(p)));
    if (!hits_.empty())
        slots(film_.hits_, hits_, 1);
}

SampleRange Film::Tile::samples_of_wave(int32_t x, int32_t y, uint64_t wave) const {
    if (film_.reach()) // also beyond the picture
        return {wave / kReplicates, 1};
    return film_.samples_of_wave(size_t(y) * film_.width_ + size_t(x), wave);
}

template <class Function>
void Film::Tile::for_pixels_around(const Cell &cell, int32_t x, int32_t y, const FilterWeights &weights,
                                   const Function &function) const {
    const auto reach = int32_t(weights.reach);
    const FilmLayout::Area &reached = cell.reached;
    const int32_t x0 = std::max(x - reach, reached.x0), x1 = std::min(x + reach + 1, reached.x1);
    const int32_t y0 = std::max(y - reach, reached.y0), y1 = std::min(y + reach + 1, reached.y1);
    for (int32_t py = y0; py < y1; ++py) {
        size_t slot = cell.slot(x0, py) - begin_;
        const float *across = weights.x.data() + (x0 - x + reach);
        for (int32_t px = x0; px < x1; ++px)
            function(slot++, *across++ * weights.y[size_t(py - y + reach)]);
    }
}

void Film::Tile::add(const Cell &cell, int32_t x, int32_t y, uint64_t wave, const FilmSample &sample,
                     const FilterWeights &weights) {
    const auto r = uint32_t(wave % kReplicates);
    // The radiance is divided by the samples that were taken in the end. All else is kept in one sum and divided by the
    // waves that its samples stand for.
    const bool by_allocation = film_.allocated_ && wave >= kUniformWaves;
    const float waves =
        by_allocation ? film_.allocation_[size_t(y) * film_.width_ + size_t(x)].waves_a_sample(r) : 1.0f;
    const Rgb radiance = sample.radiance();
    for_pixels_around(cell, x, y, weights, [&](size_t slot, float weight) { radiance_[slot][r] += radiance * weight; });
    for (uint32_t p = 0; p < GLIMMER_PASS_COUNT; ++p) {
        if (sums_[p].empty())
            continue;
        const glimmer_pass_rule rule = kPasses[p].info.rule;
        if (rule == GLIMMER_RULE_MATTE) {
            const auto number = p == GLIMMER_PASS_OBJECT_MATTE ? &Cover::object : &Cover::material;
            for_pixels_around(cell, x, y, weights, [&](size_t slot, float weight) {
                add_covers(*sample.more, number, weight * waves,
                           sums_[p].data() + slot * pass_channels(glimmer_pass(p)));
            });
            continue;
        }
        std::array<float, detail::kMaxPassChannels> value;
        kPasses[p].value(sample, value.data());
        if (rule == GLIMMER_RULE_FIRST) {
            if (wave == 0 && cell.reached.holds(x, y))
                std::copy_n(value.data(), pass_channels(glimmer_pass(p)),
                            sums_[p].data() + (cell.slot(x, y) - begin_) * pass_channels(glimmer_pass(p)));
        } else if (rule == GLIMMER_RULE_MEAN || sample.hit) {
            for_pixels_around(cell, x, y, weights, [&](size_t slot, float weight) {
                add_to_mean(glimmer_pass(p), slot, value, weight * waves);
            });
        }
    }
    if (sample.hit && !hits_.empty())
        for_pixels_around(cell, x, y, weights, [&](size_t slot, float weight) { hits_[slot] += weight * waves; });
}

void Film::Tile::add_light(const Cell &cell, int32_t x, int32_t y, uint64_t wave, const FilmSample &light,
                           const FilterWeights &weights) {
    const Rgb radiance = light.radiance();
    for_pixels_around(cell, x, y, weights,
                      [&](size_t slot, float weight) { radiance_[slot][wave % kReplicates] += radiance * weight; });
    for (uint32_t p = 0; p < GLIMMER_PASS_COUNT; ++p) {
        if (sums_[p].empty() || !(kLightPasses & bit_of(p)))
            continue;
        std::array<float, detail::kMaxPassChannels> value;
        kPasses[p].value(light, value.data());
        for_pixels_around(cell, x, y, weights,
                          [&](size_t slot, float weight) { add_to_mean(glimmer_pass(p), slot, value, weight); });
    }
}

void Film::Tile::add_to_mean(glimmer_pass pass, size_t slot, const std::array<float, detail::kMaxPassChannels> &value,
                             float weight) {
    const size_t channels = pass_channels(pass);
    float *sums = sums_[size_t(pass)].data() + slot * channels;
    for (size_t c = 0; c < channels; ++c)
        sums[c] += value[c] * weight;
}

void Film::Tile::add_covers(const PassSample &sample, uint32_t Cover::*number, float weight, float *pairs) {
    if (weight == 0)
        return;
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
