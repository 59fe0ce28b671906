// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/tile_renderer.h"

#include "camera/camera_sample.h"
#include "integrator/shutter.h"
#include "render/clock.h"
#include "sampling/dimensions.h"

#include <algorithm>

namespace glimmer {

namespace {

/// Pixels in a row between looks at the clock.
constexpr uint32_t kDeadlinePixels = 16;

} // namespace

struct TileRenderer::Work {
    Film::Tile tile;
    uint32_t origin_x, origin_y; ///< of the tile, in pixels of the whole picture
    double deadline;
    TraceContext &trace;
    SampleFaults faults;
    PassSample passes{};
};

std::optional<SampleFaults> TileRenderer::render(Film &film, size_t index, uint64_t first, double deadline,
                                                 TraceContext &trace) const {
    const Rectangle &area = film.tiles()[index];
    Work work{Film::Tile(film, index), scene_.film.crop_x + area.x, scene_.film.crop_y + area.y, deadline, trace, {}};
    if (film.passes() & kPassesOfMore)
        trace.passes = &work.passes;
    // Blocks are the integrator's. Tiles are made of whole ones, so that their size changes nothing.
    for (uint32_t by = 0; by < area.height; by += kBlockSize)
        for (uint32_t bx = 0; bx < area.width; bx += kBlockSize) {
            const Rectangle block{work.origin_x + bx, work.origin_y + by, std::min(kBlockSize, area.width - bx),
                                  std::min(kBlockSize, area.height - by)};
            for (uint64_t wave = first; wave < schedule_.end_wave(); ++wave)
                if (!render_block(work, block, wave))
                    return std::nullopt;
        }
    work.tile.commit(schedule_.end_wave());
    return work.faults;
}

bool TileRenderer::render_block(Work &work, const Rectangle &block, uint64_t wave) const {
    std::unique_ptr<const BlockData> shared; // made by the first pixel that takes a sample
    for (uint32_t y = block.y; y < block.y + block.height; ++y)
        for (uint32_t x = block.x; x < block.x + block.width; ++x) {
            if (x % kDeadlinePixels == 0 && steady_seconds() > work.deadline)
                return false;
            if (!render_pixel(work, x, y, block, wave, shared))
                return false;
        }
    return true;
}

bool TileRenderer::render_pixel(Work &work, uint32_t x, uint32_t y, const Rectangle &block, uint64_t wave,
                                std::unique_ptr<const BlockData> &shared) const {
    const uint32_t tile_x = x - work.origin_x, tile_y = y - work.origin_y;
    const SampleRange samples = work.tile.samples_of_wave(tile_x, tile_y, wave);
    for (uint64_t i = samples.first; i < samples.first + samples.count; ++i) {
        if (stop_.load(std::memory_order_relaxed))
            return false;
        if (const WaveData *data = schedule_.shared(wave); data && !shared)
            shared = integrator_.prepare_block(*data, block, work.trace);
        Sampler sampler(seed_, x, y, uint32_t(wave % kReplicates), uint32_t(i));
        ShutterTime time;
        if (scene_.moves)
            time = integrator_.shares() ? time_of_wave(seed_, wave)
                                        : ShutterTime(sampler.stratified_1d(dimension(Dimension::time)));
        const CameraRay camera = sample_camera_ray(scene_, x, y, sampler.stratified_2d(dimension(Dimension::film)),
                                                   sampler.stratified_2d(dimension(Dimension::lens)), time);
        if (work.trace.passes)
            *work.trace.passes = {};
        FilmSample value = integrator_.sample(camera, sampler, shared.get(), work.trace);
        value.more = work.trace.passes;
        if (value.unfinished && stop_.load(std::memory_order_relaxed))
            return false;
        value.expose(scene_.film.exposure);
        work.faults.unfinished += value.unfinished ? 1 : 0;
        if (is_finite(value.radiance()))
            work.tile.add(tile_x, tile_y, wave, value);
        else
            work.faults.add_invalid({x, y, wave});
    }
    return true;
}

} // namespace glimmer
