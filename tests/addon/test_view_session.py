# SPDX-License-Identifier: GPL-3.0-or-later
"""The picture of a 3D view, without Blender: one render at a time, coarse before full, read on a thread of its own."""

import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from addon.film import denoise
from addon.film.coarse import enlarged
from addon.native import library, render
from addon.native.structs import State
from addon.scene import description as d
from addon.scene.problems import GlimmerError
from addon.viewport import session as sessions
from addon.viewport.border import border_crop, camera_frame

GIVE_UP_SECONDS = 60.0
SKY = (0.25, 0.5, 2.0)


@pytest.fixture
def session(library_dir: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[sessions.Session]:
    monkeypatch.setenv("GLIMMER_LIBRARY", str(library_dir / "libglimmer.so"))
    library.load.cache_clear()
    found = sessions.Session()
    yield found
    found.close(wait=True)
    library.load.cache_clear()


def scene(size: tuple[int, int] = (160, 90), samples: int = 2, **film: Any) -> d.SceneDescription:
    """Nothing but a sky."""
    return d.SceneDescription(
        film=d.Film(*size, filter="box", **film),
        camera=d.Camera(to_world=np.eye(4), projection=d.Perspective(60.0)),
        materials=(),
        environment=d.Environment(radiance=SKY),
        settings=d.RenderSettings(samples=samples, threads=1),
    )


def wait_for(condition: Callable[[], bool]) -> None:
    end = time.monotonic() + GIVE_UP_SECONDS
    while not condition():
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.002)


def test_a_coarse_picture_comes_first_and_then_the_full_one(session: sessions.Session) -> None:
    number = session.show(scene())
    frames: list[sessions.Frame] = []

    def collect() -> bool:
        assert len(render.open_renders.all()) <= 1
        if session.has_news() and (frame := session.frame()) is not None:
            frames.append(frame)
        return bool(frames) and frames[-1].scale == 1 and frames[-1].progress.ended

    wait_for(collect)
    assert frames[0].scale == sessions.COARSE
    assert all(frame.scene == number for frame in frames)
    for frame in frames:
        np.testing.assert_array_equal(frame.pixels, np.broadcast_to(np.array(SKY, np.float32), frame.pixels.shape))
        assert (frame.rgba[..., 3] == 1.0).all()
    assert frames[-1].rgba.shape == (90, 160, 4)
    assert session.is_resting() and not session.has_news()


def test_a_transparent_film_is_empty_where_the_sky_is(session: sessions.Session) -> None:
    session.show(scene(transparent=True))
    wait_for(lambda: (frame := session.frame()) is not None and frame.scale == 1 and frame.progress.ended)
    frame = session.frame()
    assert frame is not None and frame.rgba.shape == (90, 160, 4)
    assert not frame.rgba.any()


def test_a_border_is_all_that_is_rendered(session: sessions.Session) -> None:
    session.show(scene(crop=(10, 20, 111, 80)))
    wait_for(lambda: (frame := session.frame()) is not None and frame.scale == 1 and frame.progress.ended)
    frame = session.frame()
    assert frame is not None
    assert frame.window == (10, 20, 111, 80) and frame.film_size == (160, 90)
    assert frame.rgba.shape == (60, 101, 4)


def test_a_pause_stops_the_engine_and_its_end_lets_it_go_on(session: sessions.Session) -> None:
    session.show(scene(samples=1_000_000))
    wait_for(lambda: (frame := session.frame()) is not None and frame.scale == 1)
    session.pause(True)
    wait_for(session.is_resting)
    (running,) = render.open_renders.all()
    samples = running.poll().samples
    time.sleep(0.1)
    assert running.poll().samples == samples
    session.pause(False)
    wait_for(lambda: running.poll().samples > samples)


def test_a_view_that_is_held_still_shows_a_new_scene_in_coarse_pixels(session: sessions.Session) -> None:
    session.pause(False, is_held=True)
    number = session.show(scene(samples=1_000_000))
    wait_for(lambda: (frame := session.frame()) is not None and frame.scene == number)
    wait_for(session.is_resting)
    time.sleep(2 * sessions.SETTLE_SECONDS)
    frame = session.frame()
    assert frame is not None and frame.scale == sessions.COARSE
    session.pause(False)
    wait_for(lambda: (frame := session.frame()) is not None and frame.scale == 1)


class NewsAtEveryLook:
    """In place of a render."""

    def read(self, _name: str, tile: render.Tile) -> Any:
        return np.zeros((tile.height, tile.width, 3), np.float32)


def test_pixels_are_read_ever_more_seldom(session: sessions.Session, monkeypatch: pytest.MonkeyPatch) -> None:
    clock = [0.0]
    monkeypatch.setattr(time, "monotonic", lambda: clock[0])
    fake: Any = NewsAtEveryLook()
    running = sessions._Running(fake, scene(), 1, 1, started=0.0)
    times = []
    for look in range(6000):
        clock[0] = 0.01 * look
        reads = session.counts().reads
        progress = render.Progress(State.RUNNING, look + 1, 0.0, clock[0], None, version=look)
        session._refresh(running, progress)
        if session.counts().reads > reads:
            times.append(clock[0])
    pauses = np.diff(times)
    assert pauses[0] == pytest.approx(sessions.LEAST_REFRESH_SECONDS, abs=0.011)
    assert pauses[-1] == pytest.approx(sessions.MOST_REFRESH_SECONDS, abs=0.011)
    assert (np.diff(pauses) > -0.011).all()


class FakeDenoiser:
    """Doubles every pixel."""

    def __init__(self) -> None:
        self.threads: list[str] = []
        self.is_closed = False

    def quick_picture(self, color: Any, albedo: Any, normal: Any, is_wanted: Callable[[], bool]) -> Any:
        assert color.shape == albedo.shape == normal.shape
        self.threads.append(threading.current_thread().name)
        return 2.0 * color

    def close(self) -> None:
        self.is_closed = True


def denoised_scene(samples: int) -> d.SceneDescription:
    found = scene(samples=samples)
    passes = ("combined", "albedo", "normal")
    return replace(found, settings=replace(found.settings, passes=passes, denoise=True))


def test_a_view_is_denoised_from_its_start_sample_on_by_the_thread_that_reads(
    session: sessions.Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    fake = FakeDenoiser()
    monkeypatch.setattr(denoise, "open_denoiser", lambda: fake)
    session.denoise_from(2)
    number = session.show(denoised_scene(samples=4))
    frames: dict[int, sessions.Frame] = {}

    def collect() -> bool:
        if session.has_news() and (frame := session.frame()) is not None and frame.is_whole:
            frames[frame.progress.samples] = frame
            assert frame.is_denoised == (frame.progress.samples >= 2)
            factor = 2.0 if frame.is_denoised else 1.0
            np.testing.assert_allclose(frame.pixels[0, 0], factor * np.array(SKY), rtol=1e-6)
            return frame.scale == 1 and frame.progress.ended
        return False

    wait_for(collect)
    assert frames[4].is_denoised and frames[4].scene == number
    assert set(fake.threads) == {"Glimmer view"}
    session.close(wait=True)
    assert fake.is_closed


def test_a_failed_denoiser_leaves_the_picture_as_it_was_rendered(
    session: sessions.Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail() -> Any:
        raise GlimmerError("no memory")

    monkeypatch.setattr(denoise, "open_denoiser", fail)
    session.show(denoised_scene(samples=1))
    wait_for(lambda: (frame := session.frame()) is not None and frame.scale == 1 and frame.progress.ended)
    frame = session.frame()
    assert frame is not None and not frame.is_denoised
    assert session.denoising_problem() == "no memory"


def test_a_newer_scene_stops_the_denoiser(session: sessions.Session, monkeypatch: pytest.MonkeyPatch) -> None:
    class Endless(FakeDenoiser):
        def quick_picture(self, color: Any, albedo: Any, normal: Any, is_wanted: Callable[[], bool]) -> Any:
            self.threads.append("")
            while is_wanted():
                time.sleep(0.001)
            raise denoise.StoppedError("stopped")

    fake = Endless()
    monkeypatch.setattr(denoise, "open_denoiser", lambda: fake)
    session.show(denoised_scene(samples=1))
    wait_for(lambda: bool(fake.threads))
    number = session.show(scene(samples=1))
    wait_for(lambda: (frame := session.frame()) is not None and frame.scene == number and frame.progress.ended)
    assert session.denoising_problem() == ""


def test_a_coarse_picture_is_enlarged_to_where_the_tiles_go() -> None:
    coarse = np.arange(3 * 2 * 4, dtype=np.float32).reshape(2, 3, 4)
    large = enlarged(coarse, (1, 1, 4, 3), 4, (5, 6, 15, 11))
    assert large.shape == (5, 10, 4)
    np.testing.assert_array_equal(large[0, 0], coarse[0, 0])
    np.testing.assert_array_equal(large[0, 2], coarse[0, 0])
    np.testing.assert_array_equal(large[0, 3], coarse[0, 1])
    np.testing.assert_array_equal(large[-1, 0], coarse[1, 0])


def test_a_tile_goes_where_it_was_rendered() -> None:
    canvas = np.zeros((4, 5, 4), np.float32)
    sessions.paste(canvas, render.Tile(1, 0, 2, 1), np.ones((1, 2, 3), np.float32))
    assert canvas[3, 1:3, :3].sum() == canvas.sum() == 6.0


@pytest.mark.parametrize(("height", "most"), [(1, 1), (7, 3), (1080, 546), (1080, 1080), (1081, 1080)])
def test_bands_are_even_and_leave_nothing_out(height: int, most: int) -> None:
    found = sessions.bands(height, most)
    assert [row for begin, end in found for row in range(begin, end)] == list(range(height))
    sizes = [end - begin for begin, end in found]
    assert max(sizes) <= most and max(sizes) - min(sizes) <= 1


def test_a_border_is_cut_to_what_is_in_sight() -> None:
    assert border_crop(None, (100, 50)) is None
    assert border_crop((0.25, 0.5, 0.75, 2.0), (100, 50)) == (25, 0, 75, 25)
    assert border_crop((1.5, 0.0, 2.0, 1.0), (100, 50)) is None
    assert camera_frame([(-0.5, -0.2), (0.5, 0.2)]) == pytest.approx((0.25, 0.4, 0.75, 0.6))
