# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture that follows its scene: whoever draws hands in the newest description and takes whatever is there.

No call waits for the engine: scenes are built, rendered and read on a thread of the session's own, which lives as long
as the session. A new scene appears in coarse pixels first. Once it has stood still a moment it is rendered in full, and
its tiles take the place of the coarse pixels one by one. Only one render is at work at any time.
"""

from __future__ import annotations

import threading
import time
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ..film import denoise
from ..film.coarse import Pixels, Window, enlarged, reduced
from ..film.passes import ALPHA, DENOISED_BY, with_alpha
from ..native.library import load
from ..native.open_set import OpenSet
from ..native.render import NativeRender, Progress, Tile, open_render
from ..native.scene import MeshCache
from ..scene.description import SceneDescription
from ..scene.problems import GlimmerError, describe

COARSE = 4  # pixels of the view in a row that the first picture shows as one
SETTLE_SECONDS = 0.2  # without a new scene, before the full picture replaces the coarse one
POLL_SECONDS = 0.02
# A view smaller than this is as quick in full.
MIN_COARSE_PIXELS = 64 * 64
# Between two readings of the pixels: ever longer, since noise falls ever more slowly.
LEAST_REFRESH_SECONDS = 0.1
MOST_REFRESH_SECONDS = 2.0
REFRESH_GROWTH = 0.05  # of the time that has been rendered
# Reading costs render time: no more than this share of it. Denoising takes longer, and what it shows is worth more.
MAX_REFRESH_SHARE = 0.1
MAX_DENOISE_SHARE = 0.3


@dataclass(frozen=True, eq=False)
class Frame:
    """The newest picture, linear."""

    rgba: Pixels  # (height, width, 4), premultiplied, bottom row first: as textures begin
    window: Window  # of the film, that the pixels are of
    film_size: tuple[int, int]  # width and height of the film, in its pixels
    scene: int  # the number that `show` returned for what it shows
    scale: int  # 1 in full
    progress: Progress
    is_whole: bool = True  # or parts of it are still as coarse as the picture before
    is_denoised: bool = False

    @property
    def pixels(self) -> Pixels:
        """(height, width, 3), top row first."""
        return self.rgba[::-1, :, :3]


@dataclass(frozen=True)
class Counts:
    """What happened so far, for tests and the curious."""

    scenes: int = 0  # handed in
    built: int = 0
    meshes_created: int = 0
    reads: int = 0


@dataclass(eq=False)
class _Running:
    render: NativeRender
    scene: SceneDescription
    number: int
    scale: int
    started: float
    canvas: Pixels | None = None  # coarse pixels that the tiles of a full picture go over
    shown: tuple[int, bool] = (-1, False)  # the version of its pixels that was read last, and whether it is the end
    shown_at: float = 0.0  # when the first were
    read_again_at: float = 0.0
    denoised: int = 0  # samples of the last picture that was
    is_paused: bool = False

    @property
    def window(self) -> Window:
        return self.scene.film.window

    @property
    def whole(self) -> Tile:
        x0, y0, x1, y1 = self.window
        return Tile(0, 0, x1 - x0, y1 - y0)

    def pixels(self, tile: Tile) -> Pixels:
        """With alpha, premultiplied, where the picture may be empty."""
        colors = self.render.read("combined", tile)
        return with_alpha(colors, self.render.read(ALPHA, tile)) if self.scene.has_alpha else colors


@dataclass(eq=False)
class _Failure:
    scene: int
    message: str
    is_told: bool = False


def paste(canvas: Pixels, tile: Tile, pixels: Pixels) -> None:
    """canvas: (height, width, 4), bottom row first. pixels: (tile.height, tile.width, 3 or 4), top row first."""
    bottom = canvas.shape[0] - tile.y - tile.height
    canvas[bottom : bottom + tile.height, tile.x : tile.x + tile.width, : pixels.shape[2]] = pixels[::-1]


def bands(height: int, most: int) -> list[tuple[int, int]]:
    """The rows of a picture, begin and end, in even bands of at most so many."""
    count = -(-height // most)
    edges = [height * index // count for index in range(count + 1)]
    return list(pairwise(edges))


class Session:
    """Closed by `close`; until then one thread, and while there is a scene that is not finished a render of it."""

    def __init__(self) -> None:
        self._meshes = MeshCache(load())
        self._changed = threading.Condition()
        self._wanted: SceneDescription | None = None
        self._number = 0  # of the newest scene
        self._done = 0  # of the last that the thread took up
        self._is_closing = False
        self._is_paused = self._is_held = False
        self._running: _Running | None = None
        self._frame: Frame | None = None
        self._is_seen = True  # the frame
        self._failure: _Failure | None = None
        self._built = self._reads = 0
        self._denoises_from = 1
        self._denoiser: denoise.Denoiser | None = None
        self._denoising_problem = ""
        self._thread = threading.Thread(target=self._work, name="Glimmer view", daemon=True)
        _open_sessions.add(self)
        self._thread.start()

    def show(self, scene: SceneDescription | None) -> int:
        """From now on this scene, or nothing. Returns its number."""
        with self._changed:
            self._wanted = scene
            self._number += 1
            if self._running is not None:
                self._running.render.cancel()
            if scene is None:
                self._frame = None
            self._changed.notify_all()
            return self._number

    def pause(self, is_paused: bool, is_held: bool = False) -> None:
        """Leaves the machine to others, a final render above all. is_held: as soon as the newest scene has any
        picture."""
        with self._changed:
            if (self._is_paused, self._is_held) != (is_paused, is_held):
                self._is_paused, self._is_held = is_paused, is_held
                self._changed.notify_all()

    def denoise_from(self, samples: int) -> None:
        """Of the scenes whose settings ask for it."""
        with self._changed:
            self._denoises_from = samples

    def denoising_problem(self) -> str:
        """Why pictures are shown as they were rendered; empty while nothing speaks against it."""
        with self._changed:
            return self._denoising_problem

    def has_news(self) -> bool:
        """Whether `frame` or `failure` would return something that they have not returned yet."""
        with self._changed:
            if self._failure is not None and self._failure.scene == self._number:
                return not self._failure.is_told
            return self._frame is not None and not self._is_seen

    def frame(self) -> Frame | None:
        """The newest picture, also if it is an older scene's; None while there is none."""
        with self._changed:
            self._is_seen = True
            return self._frame

    def failure(self) -> str | None:
        """Why there is no picture of the newest scene."""
        with self._changed:
            if self._failure is None or self._failure.scene != self._number:
                return None
            self._failure.is_told = True
            return self._failure.message

    def counts(self) -> Counts:
        with self._changed:
            return Counts(self._number, self._built, self._meshes.created, self._reads)

    def is_resting(self) -> bool:
        """Whether no render is at work: all are paused, or what was wanted is finished."""
        with self._changed:
            running = self._running
            return self._number == self._done and (running is None or running.is_paused)

    def close(self, wait: bool = False) -> None:
        """Ends the thread and frees everything; with `wait`, before this returns."""
        with self._changed:
            self._is_closing = True
            if self._running is not None:
                self._running.render.cancel()
            self._changed.notify_all()
        if wait:
            self._thread.join()

    # ---- The session's own thread ----

    def _work(self) -> None:
        while (job := self._next_job()) is not None:
            scene, number = job
            if scene is not None:
                self._try_to_show(scene, number)
        if self._denoiser is not None:
            self._denoiser.close()
        self._meshes.clear()
        _open_sessions.discard(self)

    def _next_job(self) -> tuple[SceneDescription | None, int] | None:
        """(the newest scene, its number); None at the end."""
        with self._changed:
            self._changed.wait_for(lambda: self._is_closing or self._number != self._done)
            if self._is_closing:
                return None
            self._done = self._number
            return self._wanted, self._number

    def _try_to_show(self, scene: SceneDescription, number: int) -> None:
        x0, y0, x1, y1 = scene.film.window
        is_small = (x1 - x0) * (y1 - y0) <= MIN_COARSE_PIXELS
        try:
            for scale in (1,) if is_small else (COARSE, 1):
                if self._is_stale(number):
                    return
                self._show_scaled(scene, number, scale)
        except Exception as error:  # noqa: BLE001 - on a thread of our own nobody else would hear of it
            with self._changed:
                self._failure = _Failure(number, describe(error))
                self._frame = None

    def _show_scaled(self, scene: SceneDescription, number: int, scale: int) -> None:
        """Until a newer scene is there, the render has ended or, of a coarse one, it is time for the next."""
        smaller = reduced(scene, scale)
        render, _ = open_render(smaller, self._meshes)
        running = _Running(render, smaller, number, scale, time.monotonic())
        with self._changed:
            self._built += 1
            older, self._running = self._frame, running
        if scale == 1 and older is not None and older.scene == number:
            running.canvas = enlarged(older.rgba[::-1], older.window, older.scale, running.window)[::-1].copy()
        try:
            render.start()
            self._watch(running)
        finally:
            with self._changed:
                self._running = None
            render.close()

    def _watch(self, running: _Running) -> None:
        while not self._is_stale(running.number):
            self._apply_pause(running)
            progress = running.render.poll()
            if progress.ended:
                running.render.wait(-1.0)  # raises the reason of a failed one
            self._refresh(running, progress)
            if progress.ended and (running.scale == 1 or self._is_settled(running)):
                return
            if running.scale > 1 and not running.is_paused and self._is_settled(running):
                return
            with self._changed:
                self._changed.wait_for(lambda: self._is_closing or self._number != running.number, POLL_SECONDS)

    def _is_settled(self, running: _Running) -> bool:
        return running.shown_at > 0.0 and time.monotonic() >= running.shown_at + SETTLE_SECONDS

    def _refresh(self, running: _Running, progress: Progress) -> None:
        """Reads the pixels where there are new ones and it is time."""
        now = time.monotonic()
        version = progress.version, progress.ended
        if version == running.shown or (now < running.read_again_at and not progress.ended):
            return
        if running.denoised == progress.samples > 0 and not progress.ended:
            return  # half a sample more is not worth the time
        is_denoised = False
        if progress.samples > 0:
            running.canvas = None
            rgba: Pixels = np.ones((running.whole.height, running.whole.width, 4), np.float32)
            paste(rgba, running.whole, running.pixels(running.whole))
            is_denoised = self._denoise(running, progress, rgba)
        elif running.canvas is None or not (tiles := running.render.changed_tiles()):
            return
        else:
            for tile in tiles:
                paste(running.canvas, tile, running.pixels(tile))
            rgba = running.canvas.copy()
        running.shown = version
        self._publish(running, rgba, progress, is_denoised)
        end = time.monotonic()
        running.shown_at = running.shown_at or end
        share, most = MAX_REFRESH_SHARE, MOST_REFRESH_SECONDS
        if is_denoised:
            share, most = MAX_DENOISE_SHARE, max(most, (end - now) / MAX_DENOISE_SHARE)
        pause = max(LEAST_REFRESH_SECONDS, REFRESH_GROWTH * (end - running.started), (end - now) / share)
        running.read_again_at = end + min(pause, most)

    def _denoise(self, running: _Running, progress: Progress, rgba: Pixels) -> bool:
        """In place, where it is time. A failure, or a newer scene, leaves the picture as it was rendered."""
        with self._changed:
            start = self._denoises_from
        if not running.scene.settings.denoise or progress.samples < start:
            return False
        try:
            if self._denoiser is None:
                self._denoiser = denoise.open_denoiser()
            albedo, normal = (running.render.read(name, running.whole)[::-1] for name in DENOISED_BY)
            colors = self._denoiser.quick_picture(
                rgba[..., :3], albedo, normal, lambda: not self._is_stale(running.number)
            )
        except GlimmerError as error:
            if not isinstance(error, denoise.StoppedError):
                with self._changed:
                    self._denoising_problem = str(error)
            return False
        rgba[..., :3] = colors
        running.denoised = progress.samples
        return True

    def _publish(self, running: _Running, rgba: Pixels, progress: Progress, is_denoised: bool) -> None:
        film = running.scene.film
        frame = Frame(
            rgba,
            running.window,
            (film.width, film.height),
            running.number,
            running.scale,
            progress,
            running.canvas is None,
            is_denoised,
        )
        with self._changed:
            self._reads += 1
            if self._wanted is not None:
                self._frame, self._is_seen = frame, False

    def _is_stale(self, number: int) -> bool:
        with self._changed:
            return self._is_closing or self._number != number

    def _apply_pause(self, running: _Running) -> None:
        # Pausing waits for the tiles that are under way: no work for the thread that draws.
        with self._changed:
            is_wanted = self._is_paused or (self._is_held and running.shown_at > 0.0)
        if running.is_paused != is_wanted:
            if is_wanted:
                running.render.pause()
            else:
                running.render.resume()
            running.is_paused = is_wanted


_open_sessions: OpenSet[Session] = OpenSet()


def pause_all(is_paused: bool) -> None:
    for session in _open_sessions.all():
        session.pause(is_paused)


def close_all() -> None:
    """For when the add-on is switched off, another file is loaded or the process ends."""
    for session in _open_sessions.all():
        session.close(wait=True)
