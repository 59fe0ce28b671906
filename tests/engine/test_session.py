# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders under way: polling, tiles, pausing, cancelling, reading, limits."""

import itertools
import os
import statistics
import threading
import time
from functools import cache
from typing import Any

import numpy as np
import pytest

from addon.native.structs import ProgressDesc, State
from addon.scene import description as d
from tests.engine.library import Render, Scene, call, rendering
from tests.engine.worlds import everything, heavy
from tests.render.build import Builder, camera, grey

INTEGRATORS = ("path", "baseline")
ENDLESS = 1 << 40
"""Samples that no test waits for."""


@cache
def small() -> Scene:
    return Scene(everything(40, 28))


@cache
def busy() -> Scene:
    return Scene(heavy())


@cache
def wide() -> Scene:
    """Many tiles that are soon done."""
    return Scene(everything(200, 150, fog=False))


def wait_for_progress(render: Render, seconds: float = 30) -> None:
    end = time.monotonic() + seconds
    while not render.poll().version:
        assert time.monotonic() < end, "nothing was rendered"
        time.sleep(0.002)


# ---- Polling -------------------------------------------------------------------------------------------------------


def polled_to_the_end(integrator: str) -> list[ProgressDesc]:
    with Render(wide(), integrator=integrator, samples=8, threads=2) as render:
        before = render.poll()
        assert (before.state, before.samples, before.version, before.rays) == (State.READY, 0, 0, 0)
        assert before.seconds == 0 and before.fraction == 0
        render.start()
        seen = [before]
        while seen[-1].state < State.FINISHED:
            seen.append(render.poll())
        render.wait()
        return [*seen, render.poll()]


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_poll_only_grows(integrator: str) -> None:
    """On a busy machine a render may be over before it was polled four times: then another."""
    for _ in range(20):
        seen = polled_to_the_end(integrator)
        for a, b in itertools.pairwise(seen):
            for name in ("samples", "fraction", "seconds", "cpu_seconds", "rays", "version", "state"):
                assert getattr(b, name) >= getattr(a, name), name
            assert 0 <= b.fraction <= 1
        last = seen[-1]
        assert (last.state, last.samples, last.fraction) == (State.FINISHED, 8, 1)
        assert last.rays > 8 * 200 * 150 and last.peak_bytes > 200 * 150 * 12
        assert 0 < last.relmse_low <= last.relmse <= last.relmse_high
        assert last.seconds > 0 and last.cpu_seconds > 0
        if len({p.version for p in seen}) > 3:
            return
    raise AssertionError("polled too seldom, 20 times")


def test_time_left_is_estimated() -> None:
    with rendering(busy(), seconds=1.0, threads=2) as render:
        time.sleep(0.5)
        progress = render.poll()
        if progress.state == State.RUNNING:
            assert 0 < progress.fraction < 1 and 0 < progress.seconds_left < 2


# ---- Tiles ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("tile_size", [0, 32, 50])
def test_tiles_cover_the_picture(tile_size: int) -> None:
    """Without gap or overlap; and none is left when all were taken."""
    with Render(wide(), samples=1, tile_size=tile_size, threads=2) as render:
        assert render.next_tile() is None
        render.run()
        cover = np.zeros((150, 200), int)
        for tile in render.tiles():
            assert tile.samples == 1 and tile.width > 0 and tile.height > 0
            cover[tile.y : tile.y + tile.height, tile.x : tile.x + tile.width] += 1
        assert (cover == 1).all()
        assert render.next_tile() is None


def test_tiles_come_as_they_are_done() -> None:
    """All while it runs, and every pixel of them is the mean of so many samples or more."""
    final = np.zeros((150, 200), np.uint64)
    handed_out, early = 0, 0
    with rendering(wide(), samples=6, tile_size=32, threads=2) as render:
        while True:
            ended = render.state >= State.FINISHED
            for tile in render.tiles():
                handed_out += 1
                early += not ended
                place = slice(tile.y, tile.y + tile.height), slice(tile.x, tile.x + tile.width)
                counts = render.read("sample_count", (tile.x, tile.y, tile.width, tile.height))
                assert (counts >= tile.samples).all() and np.unique(counts).size == 1
                assert (final[place] < tile.samples).all(), "handed out twice for the same samples"
                final[place] = tile.samples
            if ended:
                break
    assert (final == 6).all()
    assert early > 10


def test_a_tile_that_changed_again_is_handed_out_once() -> None:
    """Not once a batch: only where it stands now."""
    with Render(small(), samples=32, threads=2) as render:
        tiles = list(render.run().tiles())
        area = sum(tile.width * tile.height for tile in tiles)
        assert area == 40 * 28 and {tile.samples for tile in tiles} == {32}


# ---- Pausing -------------------------------------------------------------------------------------------------------


def cpu_seconds() -> float:
    t = os.times()
    return t.user + t.system


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_pause_really_pauses(integrator: str) -> None:
    """No ray, no pixel, no time, and no work of the processor."""
    with rendering(busy(), samples=ENDLESS, integrator=integrator, threads=4) as render:
        wait_for_progress(render)
        render.pause()
        assert render.state == State.PAUSED
        before, picture, cpu = render.poll(), render.read(), cpu_seconds()
        time.sleep(0.5)
        after = render.poll()
        assert cpu_seconds() - cpu < 0.1, "workers that should sleep are busy"
        for name in ("rays", "version", "samples", "seconds", "cpu_seconds", "fraction"):
            assert getattr(after, name) == getattr(before, name), name
        assert (render.read() == picture).all()
        render.pause()  # twice is once
        render.wait(0.05)  # a paused render has not ended
        assert render.state == State.PAUSED
        render.resume()
        assert render.poll().state == State.RUNNING
        end = time.monotonic() + 30
        while render.poll().version == before.version:
            assert time.monotonic() < end, "did not go on"
            time.sleep(0.005)


def test_cancel_of_a_paused_render() -> None:
    with rendering(busy(), samples=ENDLESS, threads=2) as render:
        render.pause()
        render.cancel()
        render.wait()
        assert render.state == State.CANCELLED


# ---- Cancelling ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_cancel_within_100_ms(integrator: str) -> None:
    """Until the workers have stopped: the median of ten, at different moments of a heavy render."""
    waits = []
    for i in range(10):
        with rendering(busy(), samples=ENDLESS, integrator=integrator, threads=2) as render:
            time.sleep(0.03 + 0.05 * i)
            assert render.state == State.RUNNING
            start = time.monotonic()
            render.cancel()
            render.wait()
            waits.append(time.monotonic() - start)
            assert render.poll().state == State.CANCELLED
    assert statistics.median(waits) < 0.1, sorted(waits)


def test_cancel_of_a_path_that_finds_no_end() -> None:
    """White walls and white fog: a single sample takes ten million vertices, and its light is outside."""
    room = Builder(camera((0, 0, 0), (0, 1, 0), 60), 1, 1, medium=d.Medium(grey(0), grey(1)))
    room.sphere((0, 0, 0), 1, d.Lambert(grey(1))).sphere((5, 0, 0), 1, d.Light(grey(1)))
    with rendering(Scene(room.done()), samples=ENDLESS, integrator="baseline", threads=2) as render:
        time.sleep(0.3)
        start = time.monotonic()
        render.cancel()
        render.wait()
        assert time.monotonic() - start < 1
        assert render.poll().samples == 0 and not render.read().any()


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_what_was_finished_can_be_read_after_cancel(integrator: str) -> None:
    with rendering(wide(), samples=ENDLESS, integrator=integrator, threads=2) as render:
        while render.poll().samples < 2:
            time.sleep(0.005)
        render.cancel()
        render.wait()
        picture, progress = render.read(), render.poll()
        assert progress.samples >= 2 and progress.invalid_samples == 0
        assert np.isfinite(picture).all() and picture.max() > 0
        time.sleep(0.05)
        assert (render.read() == picture).all() and render.poll().rays == progress.rays
        assert render.report()["spp"] == progress.samples


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_destroy_while_running(integrator: str) -> None:
    """Cancels, waits and frees, as fast as a cancel: also where nothing has been rendered yet."""
    waits = []
    for i in range(10):
        render = Render(busy(), samples=ENDLESS, integrator=integrator, threads=3)
        render.start()
        time.sleep(0.03 * i)
        start = time.monotonic()
        render.close()
        waits.append(time.monotonic() - start)
    assert statistics.median(waits) < 0.1, sorted(waits)


def test_destroy_of_the_scene_while_its_render_runs() -> None:
    """Every object counts its references."""
    scene = Scene(everything(40, 28))
    with rendering(scene, samples=30, threads=2) as render:
        del scene
        render.wait()
        assert render.state == State.FINISHED and np.isfinite(render.read()).all()


def test_cancel_before_start_and_twice() -> None:
    with Render(small(), samples=4) as render:
        render.cancel()
        assert render.state == State.CANCELLED
        render.cancel()
        assert render.state == State.CANCELLED


# ---- Waiting and limits ---------------------------------------------------------------------------------------------


def test_wait_has_a_limit() -> None:
    with rendering(busy(), samples=ENDLESS, threads=2) as render:
        for seconds in (0.0, 0.15):
            start = time.monotonic()
            render.wait(seconds)
            took = time.monotonic() - start
            assert seconds <= took < seconds + 0.5
            assert render.state == State.RUNNING


def test_samples_limit_is_exact() -> None:
    for samples in (1, 2, 3, 13):
        with Render(small(), samples=samples, threads=2) as render:
            assert render.run().poll().samples == samples
            assert (render.read("sample_count") == samples).all()


def test_default_is_64_samples() -> None:
    with Render(Scene(everything(8, 8, fog=False))) as render:
        assert render.run().poll().samples == 64


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_time_limit(integrator: str) -> None:
    """At least one sample everywhere, and an end although no sample limit is near: a busy machine may take its time."""
    with Render(small(), seconds=0.5, integrator=integrator, threads=2) as render:
        start = time.monotonic()
        render.run()
        took = time.monotonic() - start
        progress = render.poll()
        assert progress.state == State.FINISHED and progress.samples >= 1
        assert 0.5 <= progress.seconds <= took


def test_error_limit() -> None:
    """Stops by the upper end of the interval, at a look; a second, smaller target takes more samples. In a scene of
    light tails: another would go on."""
    room = Builder(camera((0.4, -1, 0.3), (0, 1, 0), 80), 32, 32, medium=d.Medium(grey(0), grey(0.3)))
    scene = Scene(room.sphere((0, 0, 0), 2, d.Light(grey(1))).sphere((0, 0.5, 0), 0.5, d.Lambert(grey(0.9))).done())
    samples = []
    for target in (0.02, 0.0005):
        with Render(scene, integrator="baseline", target_error=target, samples=1 << 12, threads=2) as render:
            progress = render.run().poll()
            assert progress.state == State.FINISHED
            assert progress.relmse_high <= target
            samples.append(progress.samples)
    assert samples[0] < samples[1]


def test_limits_of_depth_are_named_biases() -> None:
    with Render(small(), samples=1, max_depth=3, max_scatter=1) as render:
        assert render.run().report()["biased_by"] == ["max_depth 3", "max_scatter 1"]
    with Render(small(), samples=1) as render:
        assert render.run().report()["biased_by"] == []


# ---- Reading -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_reading_while_running_gives_finite_means(integrator: str) -> None:
    """From four threads at once, every pass, whole pictures and parts, until it ends."""
    names = ("combined", "albedo", "normal", "depth", "direct", "fog", "sample_count")
    stop, problems, reads = threading.Event(), [], [0]
    with Render(wide(), samples=24, integrator=integrator, threads=2, passes=names, tile_size=32) as render:

        def reader(seed: int) -> None:
            rng = np.random.default_rng(seed)
            while not stop.is_set():
                name = str(rng.choice(names))
                x, y = int(rng.integers(200)), int(rng.integers(150))
                part = x, y, int(rng.integers(1, 201 - x)), int(rng.integers(1, 151 - y))
                pixels = render.read(name, part if rng.random() < 0.7 else None)
                if not np.isfinite(pixels).all():
                    problems.append(name)
                reads[0] += 1

        readers = [threading.Thread(target=reader, args=(i,)) for i in range(4)]
        render.start()
        for thread in readers:
            thread.start()
        render.wait()
        stop.set()
        for thread in readers:
            thread.join()
        assert not problems and reads[0] > 20
        assert render.poll().invalid_samples == 0


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_parts_are_of_the_whole(integrator: str) -> None:
    with Render(wide(), samples=2, integrator=integrator, threads=2) as render:
        whole = render.run().read()
        for x, y, width, height in ((0, 0, 200, 150), (31, 17, 70, 90), (199, 149, 1, 1), (5, 5, 0, 3)):
            assert (render.read("combined", (x, y, width, height)) == whole[y : y + height, x : x + width]).all()


def test_passes_that_need_not_be_asked_for() -> None:
    with Render(small(), samples=2) as render:
        render.run()
        assert np.isfinite(render.read("stderr")).all() and (render.read("sample_count") == 2).all()
    with Render(small(), samples=1) as render:
        assert np.isnan(render.run().read("stderr")).all()


def test_light_by_the_way_it_came_adds_up() -> None:
    parts = ("emission", "direct", "indirect", "fog")
    for integrator in INTEGRATORS:
        with Render(small(), samples=8, passes=parts, integrator=integrator) as render:
            total = render.run().read().astype(np.float64)
            summed = sum(render.read(name).astype(np.float64) for name in parts)
            assert np.abs(total - summed).max() <= 64 * 2.0**-24 * np.abs(total).max()
            assert all(render.read(name).any() for name in parts)


def test_two_renders_of_one_scene_at_once() -> None:
    def run(seed: int, results: dict[int, Any]) -> None:
        with Render(small(), samples=4, seed=seed, threads=2) as render:
            results[seed] = render.run().read()

    together: dict[int, Any] = {}
    threads = [threading.Thread(target=run, args=(seed, together)) for seed in (1, 2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    alone: dict[int, Any] = {}
    for seed in (1, 2):
        run(seed, alone)
        assert (alone[seed] == together[seed]).all()


def test_report_while_running() -> None:
    with rendering(busy(), samples=ENDLESS, threads=2) as render:
        report = render.report()
        assert report["invalid_samples"]["count"] == 0 and report["seconds"]["render"] >= 0
        call("glimmer_render_cancel", render.handle)
