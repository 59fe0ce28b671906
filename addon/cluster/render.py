# SPDX-License-Identifier: GPL-3.0-or-later
"""A render by `glimmer farm`, used as one of the engine is (native/render.py)."""

from __future__ import annotations

import os
import subprocess
import tempfile
import time
from contextlib import suppress
from math import nan
from pathlib import Path
from types import TracebackType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..native.library import load
from ..native.open_set import OpenSet
from ..native.render import Progress, Tile
from ..native.structs import State
from ..scene.description import SceneDescription
from ..scene.problems import GlimmerError
from ..scene.writer import material_numbers, write_scene
from .live_files import Picture, Told, read_picture, read_told
from .settings import Cluster

# A render that is ended writes what is there; the command waits some seconds for its workers.
END_SECONDS = 20.0
INTERRUPTED = 130
OWN_PASSES = ("combined", "stderr")  # that are there without being asked for


class ClusterRender:
    """Use it in a `with`; it ends the command and removes its files at the end."""

    def __init__(self, scene: SceneDescription, cluster: Cluster, folder: Path) -> None:
        """folder: for files, while it renders."""
        self._scene, self._cluster = scene, cluster
        self._files = tempfile.TemporaryDirectory(prefix="glimmer-cluster-", dir=folder)
        self._folder = Path(self._files.name)
        self._passes = load().passes()
        self._process: subprocess.Popen[bytes] | None = None
        self._told, self._picture = Told(), Picture((), np.zeros((0, 0, 0), np.float32))
        self._seen = 0  # pictures
        self._cancelled_at: float | None = None
        self.material_numbers = material_numbers(scene)
        self.has_alpha = scene.has_alpha
        open_renders.add(self)

    def __enter__(self) -> ClusterRender:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        if self._process is not None and self._process.poll() is None:
            self._process.kill()
            self._process.wait()
        self._files.cleanup()
        open_renders.discard(self)

    def _words(self, scene: Path) -> list[str]:
        settings, cluster = self._scene.settings, self._cluster
        words = [str(cluster.command), "farm", str(scene), "--live", str(self._folder), "--quiet"]
        words += ["--range", str(cluster.task_samples), "--seed", str(settings.seed % 2**64)]
        words += ["--scheduler", cluster.scheduler] if cluster.scheduler else []
        words += ["--spp", str(settings.samples)] if settings.samples else []
        words += ["--error", repr(settings.target_error)] if settings.target_error else []
        words += ["--time", repr(settings.seconds)] if settings.seconds else []
        words += ["--integrator", settings.integrator] if settings.integrator else []
        words += ["--adaptive"] if settings.adaptive else []
        words += ["--independent-pixels"] if settings.independent_pixels else []
        names = [*settings.passes, *(["alpha"] if self.has_alpha else [])]
        aovs = [name for name in dict.fromkeys(names) if name not in OWN_PASSES]
        return [*words, "--aov", ",".join(aovs)] if aovs else words

    def start(self) -> None:
        path = self._folder / "scene" / "scene.json"
        write_scene(self._scene, path)
        # Blender's own Python is another one than the command's.
        env = {name: value for name, value in os.environ.items() if name not in ("PYTHONHOME", "PYTHONPATH")}
        try:
            with (self._folder / "lines").open("wb") as lines:
                self._process = subprocess.Popen(
                    self._words(path),
                    stdin=subprocess.PIPE,
                    stdout=subprocess.DEVNULL,
                    stderr=lines,
                    env=env,
                    start_new_session=True,  # Ctrl C in a terminal is for Blender, which tells us
                )
        except OSError as error:
            raise GlimmerError(f"{self._cluster.command} cannot be run: {error.strerror}") from error

    def cancel(self) -> None:
        """The command ends when its standard input does."""
        if self._cancelled_at is None and self._process is not None and self._process.stdin is not None:
            self._cancelled_at = time.monotonic()
            self._process.stdin.close()

    def wait(self, seconds: float) -> None:
        """Until the render has ended, or for some seconds. Raises GlimmerError with the reason of a failed render."""
        if self._process is None:
            return
        with suppress(subprocess.TimeoutExpired):
            self._process.wait(None if seconds < 0 else seconds)
        if self._state() == State.FAILED:
            raise GlimmerError(f"Render on Cluster: {self._reason()}")

    def _state(self) -> State:
        status = None if self._process is None else self._process.poll()
        if status is None:
            return State.RUNNING
        if status == 0:
            return State.FINISHED
        # One that is ended before there is a picture fails, which is no news.
        return State.CANCELLED if status == INTERRUPTED or self._cancelled_at is not None else State.FAILED

    def _lines(self) -> list[str]:
        return (self._folder / "lines").read_text(errors="replace").splitlines()

    def _reason(self) -> str:
        status = 0 if self._process is None else self._process.returncode
        last = (self._lines() or [f"{self._cluster.command} ended with status {status}"])[-1]
        return last.removeprefix("glimmer farm: ")

    def poll(self) -> Progress:
        state = self._state()  # before the files: what they say then is the last
        self._told = read_told(self._folder) or self._told
        if state == State.RUNNING and self._is_stuck() and self._process is not None:
            self._process.kill()
        report, settings = self._told.report, self._scene.settings
        samples, error = int(report.get("spp", 0)), report.get("error") or {}
        tails = error.get("tails") or {}
        seconds = float(report.get("seconds", {}).get("render", 0.0))
        limit = settings.samples or (0 if settings.seconds or settings.target_error else 64)
        fraction = max(
            samples / limit if limit else 0.0,
            seconds / settings.seconds if settings.seconds else 0.0,
            min(settings.target_error / error["high"], 1.0) if settings.target_error and error.get("high") else 0.0,
        )
        fraction = 1.0 if state == State.FINISHED else min(fraction, 0.99)
        return Progress(
            state=state,
            samples=samples,
            fraction=fraction,
            seconds=seconds,
            seconds_left=seconds * (1.0 / fraction - 1.0) if samples and fraction else None,
            relmse=_number(error.get("relmse")),
            relmse_low=_number(error.get("low")),
            relmse_high=_number(error.get("high")),
            heavy_tails=not tails.get("certifiable", True),
            workers=self._told.workers,
        )

    def _is_stuck(self) -> bool:
        return self._cancelled_at is not None and time.monotonic() - self._cancelled_at > END_SECONDS

    def changed_tiles(self) -> list[Tile]:
        """The whole window, when there is another picture of it."""
        if self._told.pictures == self._seen:
            return []
        x0, y0, x1, y1 = self._scene.film.window
        self._seen, self._picture = self._told.pictures, read_picture(self._folder, (x0, y0, x1, y1))
        return [Tile(0, 0, x1 - x0, y1 - y0)]

    def read(self, name: str, tile: Tile) -> NDArray[np.float32]:
        """(height, width, channels) of a pass, top row first; 0 where there is no picture yet."""
        letters = self._passes[name][1]
        prefix = "" if name in ("combined", "alpha") else f"{name}."
        result = np.zeros((tile.height, tile.width, len(letters)), np.float32)
        part = self._picture.pixels[tile.y : tile.y + tile.height, tile.x : tile.x + tile.width]
        for i, letter in enumerate(letters):
            if prefix + letter in self._picture.channels:
                result[..., i] = part[..., self._picture.channels.index(prefix + letter)]
        return result

    def report(self) -> dict[str, Any]:
        """What befell workers is among its warnings."""
        report = dict(self._told.report)
        lines = self._lines() if report and self._state() != State.RUNNING else []
        report["warnings"] = [*report.get("warnings", []), *lines]
        report["warning_codes"] = [*report.get("warning_codes", []), *("cluster" for _ in lines)]
        return report


def _number(value: float | None) -> float:
    return nan if value is None else float(value)


open_renders: OpenSet[ClusterRender] = OpenSet()


def close_all() -> None:
    for render in open_renders.all():
        render.close()
