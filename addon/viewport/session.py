# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture that follows its scene: whoever draws hands in the newest description and takes whatever is there.

No call waits for the engine: scenes are built and renders started and freed on a thread of the session's own, which
lives as long as the session. A new scene appears in coarse pixels first, and in full once it has stood still a moment.
"""

from __future__ import annotations

import threading
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..native.library import load
from ..native.open_set import OpenSet
from ..native.render import NativeRender, Progress, Tile, open_render
from ..native.scene import MeshCache
from ..scene.description import SceneDescription
from ..scene.problems import describe

COARSE = 4  # pixels of the view in a row that the first picture shows as one
SETTLE_SECONDS = 0.2  # without a new scene, before the full picture replaces the coarse one
POLL_SECONDS = 0.02
# A view smaller than this is as quick in full.
MIN_COARSE_PIXELS = 64 * 64


@dataclass(frozen=True, eq=False)
class Frame:
    """The newest picture, linear."""

    pixels: NDArray[np.float32]  # (height, width, 3), top row first
    scene: int  # the number that `show` returned for what it shows
    scale: int  # 1 in full
    progress: Progress


@dataclass(frozen=True)
class Counts:
    """What happened so far, for tests and the curious."""

    scenes: int = 0  # handed in
    built: int = 0
    meshes_created: int = 0


@dataclass(eq=False)
class _Running:
    render: NativeRender
    size: tuple[int, int]
    scene: int
    scale: int
    seen: int = -1  # the version of its pixels that was handed out
    is_paused: bool = False


@dataclass(eq=False)
class _Failure:
    scene: int
    message: str
    is_told: bool = False


def reduced(scene: SceneDescription, scale: int) -> SceneDescription:
    """The same view in pixels of `scale` by `scale` as large."""
    film = scene.film
    width, height = -(-film.width // scale), -(-film.height // scale)
    return replace(scene, film=replace(film, width=width, height=height))


class Session:
    """Closed by `close`; until then one thread, and while there is a scene a render of it."""

    def __init__(self) -> None:
        self._meshes = MeshCache(load())
        self._changed = threading.Condition()
        self._wanted: SceneDescription | None = None
        self._number = 0  # of the newest scene
        self._done = 0  # of the last that the thread took up
        self._is_closing = False
        self._is_paused = False
        self._running: _Running | None = None
        self._failure: _Failure | None = None
        self._built = 0
        self._thread = threading.Thread(target=self._work, name="Glimmer view", daemon=True)
        _open_sessions.add(self)
        self._thread.start()

    def show(self, scene: SceneDescription | None) -> int:
        """From now on this scene, or nothing. Returns its number."""
        with self._changed:
            self._wanted = scene
            self._number += 1
            if self._running is not None:
                self._running.render.cancel()  # its pixels stay until there are others
                if scene is None:
                    self._running.seen = -1
            self._changed.notify_all()
            return self._number

    def pause(self, is_paused: bool) -> None:
        """Leaves the machine to others, a final render above all."""
        with self._changed:
            self._is_paused = is_paused
            self._changed.notify_all()

    def has_news(self) -> bool:
        """Whether `frame` or `failure` would return something that they have not returned yet."""
        with self._changed:
            if self._failure is not None and self._failure.scene == self._number:
                return not self._failure.is_told
            running = self._running
            if running is None or self._wanted is None:
                return False
            progress = running.render.poll()
            return progress.samples > 0 and progress.version != running.seen

    def frame(self) -> Frame | None:
        """The newest picture, also if it is an older scene's; None while there is none."""
        with self._changed:
            running = self._running
            if running is None or self._wanted is None:
                return None
            progress = running.render.poll()
            if progress.samples == 0:
                return None
            running.seen = progress.version
            pixels = running.render.read("combined", Tile(0, 0, *running.size))
            return Frame(pixels, running.scene, running.scale, progress)

    def failure(self) -> str | None:
        """Why there is no picture of the newest scene."""
        with self._changed:
            if self._failure is None or self._failure.scene != self._number:
                return None
            self._failure.is_told = True
            return self._failure.message

    def counts(self) -> Counts:
        with self._changed:
            return Counts(self._number, self._built, self._meshes.created)

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
            scene, number, is_new = job
            if not is_new:
                self._apply_pause(self._running)
            elif scene is None:
                self._swap(None)
            else:
                self._try_to_show(scene, number)
        self._swap(None)
        self._meshes.clear()
        _open_sessions.discard(self)

    def _next_job(self) -> tuple[SceneDescription | None, int, bool] | None:
        """(the newest scene, its number, whether it was not handed out before); None at the end."""

        def is_something_to_do() -> bool:
            return self._is_closing or self._number != self._done or self._wants_pause(self._running)

        with self._changed:
            self._changed.wait_for(is_something_to_do)
            if self._is_closing:
                return None
            is_new, self._done = self._number != self._done, self._number
            return self._wanted, self._number, is_new

    def _try_to_show(self, scene: SceneDescription, number: int) -> None:
        is_small = scene.film.width * scene.film.height <= MIN_COARSE_PIXELS
        try:
            for scale in (1,) if is_small else (COARSE, 1):
                if not self._show_scaled(scene, number, scale):
                    return
        except Exception as error:  # noqa: BLE001 - on a thread of our own nobody else would hear of it
            with self._changed:
                self._failure = _Failure(number, describe(error))
            self._swap(None)

    def _show_scaled(self, scene: SceneDescription, number: int, scale: int) -> bool:
        """False as soon as a newer scene is there."""
        smaller = reduced(scene, scale)
        render, _ = open_render(smaller, self._meshes)
        running = _Running(render, (smaller.film.width, smaller.film.height), number, scale)
        try:
            with self._changed:
                self._built += 1
            render.start()
            # The older picture stands until this one has something to show.
            while not self._is_stale(number):
                self._apply_pause(running)
                progress = render.poll()
                if progress.samples > 0 or progress.ended:
                    break
                render.wait(POLL_SECONDS)
            else:
                render.close()
                return False
        except BaseException:
            render.close()
            raise
        self._swap(running)
        if scale > 1:
            with self._changed:
                self._changed.wait_for(lambda: self._is_closing or self._number != number, SETTLE_SECONDS)
        return not self._is_stale(number)

    def _is_stale(self, number: int) -> bool:
        with self._changed:
            return self._is_closing or self._number != number

    def _wants_pause(self, running: _Running | None) -> bool:
        """Or wants none where there is one."""
        return running is not None and running.is_paused != self._is_paused

    def _apply_pause(self, running: _Running | None) -> None:
        # Pausing waits for the tiles that are under way: no work for the thread that draws.
        if running is not None and self._wants_pause(running):
            running.is_paused = not running.is_paused
            if running.is_paused:
                running.render.pause()
            else:
                running.render.resume()

    def _swap(self, running: _Running | None) -> None:
        with self._changed:
            old, self._running = self._running, running
        if old is not None:
            old.render.close()


_open_sessions: OpenSet[Session] = OpenSet()


def close_all() -> None:
    """For when the add-on is switched off, another file is loaded or the process ends."""
    for session in _open_sessions.all():
        session.close(wait=True)
