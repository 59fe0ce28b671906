// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/tile_renderer.h"

#include "camera/camera_sample.h"
#include "integrator/shutter.h"
#include "render/clock.h"
#include "sampling/dimensions.h"

#include <algorithm>
#include <span>

namespace glimmer {

namespace {

/// Pixels in a row between looks at the clock.
constexpr uint32_t kDeadlinePixels = 16;
static_assert(kCellSize == kBlockSize, "the pixels of a cell would belong to several blocks");

} // namespace

struct TileRenderer::Work {
    Film::Tile tile;
    double deadline;
    TraceContext &trace;
    SampleFaults faults;
    PassSample passes{};
    SampleParts parts{}; ///< of one sample; used where a sample counts for several pixels
};

/// Where the camera's rays of one wave go in their pixels, and what they count for.
struct TileRenderer::WaveOffset {
    Vec2f folded;
    FilterWeights weights;
};

std::optional<SampleFaults> TileRenderer::render(Film &film, size_t index, uint64_t first, double deadline,
                                                 TraceContext &trace) const {
    Work work{Film::Tile(film, index), deadline, trace, {}};
    if (film.passes() & kPassesOfMore)
        trace.passes = &work.passes;
    const std::vector<Film::Cell> &cells = film.cells(index);
    const auto same_block = [](const Film::Cell &a, const Film::Cell &b) {
        return a.block.x == b.block.x && a.block.y == b.block.y;
    };
    for (auto begin = cells.begin(); begin != cells.end();) {
        const auto end = std::find_if(begin, cells.end(), [&](const auto &cell) { return !same_block(*begin, cell); });
        for (uint64_t wave = first; wave < schedule_.end_wave(); ++wave)
            if (!render_cells(work, {begin, end}, wave))
                return std::nullopt;
        begin = end;
    }
    work.tile.commit(schedule_.end_wave());
    return work.faults;
}

/// All pixels have the same, so that the samples of a wave lie evenly: about each pixel their weights sum to 1. It is
/// uniform over seeds, and the waves of a replicate are stratified against each other.
std::optional<TileRenderer::WaveOffset> TileRenderer::offset_of_wave(const Film &film, uint64_t wave) const {
    if (!film.reach())
        return std::nullopt;
    constexpr uint32_t kNoPixel = 0x7fffffff;
    const Sampler sampler(seed_, kNoPixel, kNoPixel, uint32_t(wave % kReplicates), uint32_t(wave / kReplicates));
    const Vec2f u = sampler.stratified_2d(dimension(Dimension::film));
    const PixelFilter &filter = scene_.film.filter;
    const Vec2f folded{filter.sample_folded(u.x), filter.sample_folded(u.y)};
    return WaveOffset{folded, filter.weights(folded)};
}

bool TileRenderer::render_cells(Work &work, std::span<const Film::Cell> cells, uint64_t wave) const {
    std::unique_ptr<const BlockData> shared; // made by the first pixel that takes a sample
    const std::optional<WaveOffset> offset = offset_of_wave(work.tile.film(), wave);
    for (const Film::Cell &cell : cells)
        for (int32_t y = cell.sampled.y0; y < cell.sampled.y1; ++y)
            for (int32_t x = cell.sampled.x0; x < cell.sampled.x1; ++x) {
                if (uint32_t(x) % kDeadlinePixels == 0 && steady_seconds() > work.deadline)
                    return false;
                if (!render_pixel(work, cell, x, y, wave, offset, shared))
                    return false;
            }
    return true;
}

bool TileRenderer::render_pixel(Work &work, const Film::Cell &cell, int32_t x, int32_t y, uint64_t wave,
                                const std::optional<WaveOffset> &offset,
                                std::unique_ptr<const BlockData> &shared) const {
    const FilmSettings &film = scene_.film;
    const uint32_t picture_x = film.crop_x + uint32_t(x), picture_y = film.crop_y + uint32_t(y);
    const SampleRange samples = work.tile.samples_of_wave(x, y, wave);
    for (uint64_t i = samples.first; i < samples.first + samples.count; ++i) {
        if (stop_.load(std::memory_order_relaxed))
            return false;
        if (const WaveData *data = schedule_.shared(wave); data && !shared) {
            const Rectangle &b = cell.block;
            shared =
                integrator_.prepare_block(*data, {film.crop_x + b.x, film.crop_y + b.y, b.width, b.height}, work.trace);
        }
        Sampler sampler(seed_, picture_x, picture_y, uint32_t(wave % kReplicates), uint32_t(i));
        ShutterTime time;
        if (scene_.moves)
            time = integrator_.shares() ? time_of_wave(seed_, wave)
                                        : ShutterTime(sampler.stratified_1d(dimension(Dimension::time)));
        const Vec2f u_lens = sampler.stratified_2d(dimension(Dimension::lens));
        const CameraRay camera =
            offset ? camera_ray_at(scene_, picture_x, picture_y, offset->folded, u_lens, time)
                   : sample_camera_ray(scene_, picture_x, picture_y, sampler.stratified_2d(dimension(Dimension::film)),
                                       u_lens, time);
        if (work.trace.passes)
            *work.trace.passes = {};
        if (offset)
            work.parts.clear(work.trace.passes != nullptr);
        SampleParts &parts = work.parts;
        FilmSample value = integrator_.sample(camera, sampler, shared.get(), work.trace, offset ? &parts : nullptr);
        value.more = work.trace.passes;
        if (offset && work.trace.passes)
            parts.show_passes();
        if (value.unfinished && stop_.load(std::memory_order_relaxed))
            return false;
        work.faults.unfinished += value.unfinished ? 1 : 0;
        value.expose(film.exposure);
        Rgb radiance = value.radiance();
        if (offset)
            for (FilmSample *part : {&parts.seen, &parts.resampled, &parts.own}) {
                part->expose(film.exposure);
                radiance += part->radiance();
            }
        if (!is_finite(radiance)) {
            const Rectangle &b = cell.block; // the pixel, or the nearest in the picture
            work.faults.add_invalid({film.crop_x + uint32_t(std::clamp(x, int32_t(b.x), int32_t(b.x + b.width) - 1)),
                                     film.crop_y + uint32_t(std::clamp(y, int32_t(b.y), int32_t(b.y + b.height) - 1)),
                                     wave});
            continue;
        }
        if (offset) {
            work.tile.add(cell, x, y, wave, value, offset->weights);
            add_parts(work, cell, x, y, wave, parts, offset->weights);
        } else {
            work.tile.add(cell, x, y, wave, value);
        }
    }
    return true;
}

void TileRenderer::add_parts(Work &work, const Film::Cell &cell, int32_t x, int32_t y, uint64_t wave,
                             const SampleParts &parts, const FilterWeights &weights) const {
    if (parts.resampled.has_light())
        work.tile.add_light(cell, x, y, wave, parts.resampled, scene_.film.filter.weights(parts.resampled_at));
    if (parts.own.has_light())
        work.tile.add_light(cell, x, y, wave, parts.own, {});
    if (!parts.seen.has_light())
        return;
    const auto reach = int32_t(weights.reach);
    for (int32_t j = -reach; j <= reach; ++j)
        for (int32_t i = -reach; i <= reach; ++i) {
            FilterWeights of_pixel;
            of_pixel.x[0] =
                weights.x[size_t(reach + i)] * weights.y[size_t(reach + j)] *
                integrator_.weight_of_seen(scene_.film.crop_x + uint32_t(x + i), scene_.film.crop_y + uint32_t(y + j));
            work.tile.add_light(cell, x + i, y + j, wave, parts.seen, of_pixel);
        }
}

} // namespace glimmer
