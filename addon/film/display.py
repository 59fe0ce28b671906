# SPDX-License-Identifier: GPL-3.0-or-later
"""Watches a render and hands its pixels to Blender: tiles as they finish, every pass at the end."""

from __future__ import annotations

import time
from collections.abc import Callable
from math import isnan
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..native.render import Progress, Render, Tile
from ..scene.description import SceneDescription
from ..scene.problems import GlimmerError
from . import cryptomatte, denoise
from .noise import FIREFLIES, noise_text
from .passes import ALPHA, COMBINED, Pixels, Reader, RenderPass, hand_over, with_alpha

if TYPE_CHECKING:
    import bpy

POLL_SECONDS = 0.05  # also how late Esc may be noticed
STATUS_SECONDS = 0.25  # in background every line is printed
REFRESH_SECONDS = 0.5
# Handing pixels over costs render time: never more than this share of it.
MAX_REFRESH_SHARE = 0.05
# More changed tiles than this are handed over as one: each costs Blender a lock and a redraw.
MAX_TILES = 16
NOT_CERTIFIABLE = "Not certifiable: heavy tails"


def status(progress: Progress, samples: int) -> str:
    """The line that Blender shows while rendering, and prints in background, where `build.py render` reads it and who
    watches a render farm looks for "Noise". samples: of each pixel in the end; 0 is no limit.
    """
    parts = [f"Sample {progress.samples}/{samples}" if samples else f"Sample {progress.samples}"]
    if progress.fraction > 0:
        parts.append(f"{100 * progress.fraction:.0f} %")
    if progress.seconds_left is not None:
        parts.append(f"Left {clock(progress.seconds_left)}")
    if not isnan(progress.relmse):
        parts.append(f"Noise {noise_text(progress.relmse, progress.relmse_low, progress.relmse_high)}")
        if progress.heavy_tails:
            parts.append(FIREFLIES)
        if progress.seconds_to_target is not None:
            parts.append(f"Noise limit in {clock(progress.seconds_to_target)}")
    if progress.workers is None:
        parts.append(f"Mem {progress.peak_bytes / 2**20:.0f} MB")
    else:
        parts.append(f"{progress.workers} worker{'' if progress.workers == 1 else 's'}")
    return " | ".join(parts)


def error_text(relmse: float, low: float | None, high: float | None) -> str:
    if low is None or high is None or isnan(low) or isnan(high):
        return f"{relmse:.2g}"
    return f"{relmse:.2g} ({low:.2g} to {high:.2g})"


def clock(seconds: float) -> str:
    minutes, rest = divmod(int(seconds + 0.5), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02d}:{rest:02d}" if hours else f"{minutes:02d}:{rest:02d}"


class Display:
    def __init__(
        self,
        engine: bpy.types.RenderEngine,
        render: Render,
        scene: SceneDescription,
        passes: tuple[RenderPass, ...],
        layer: str,
        watch: Callable[[dict[str, Any]], None] | None = None,
        view: str = "",
        coarse: Pixels | None = None,
    ) -> None:
        """watch: is told the engine's report whenever there is a new one. view: of a stereoscopic render. coarse:
        (height, width, 4), top row first: what is seen until the first sample is there."""
        self._engine = engine
        self._render = render
        self._settings = scene.settings
        self._passes = passes
        self._denoises = scene.settings.denoise
        self.denoised = False
        self.problem = ""  # why the picture could not be denoised
        self._layer = layer
        self._view = view
        self._names = cryptomatte.Names(
            [matte.name for matte in scene.mattes],
            self._material_names(scene),
            [matte.asset for matte in scene.mattes],
        )
        self._watch = watch
        self._canvas = coarse  # tiles of the first sample go over it
        x0, y0, x1, y1 = scene.film.window
        self._whole = Tile(0, 0, x1 - x0, y1 - y0)
        self._has_alpha = render.has_alpha
        self._material_indices = self._index_table(scene)
        self._to_camera = scene.camera.to_world[:3, :3].T

    def _index_table(self, scene: SceneDescription) -> NDArray[np.float32]:
        """Blender's material index of each of the engine's numbers, which count from 1."""
        numbers = self._render.material_numbers
        table = np.zeros(max(numbers, default=0) + 2, np.float32)
        for number, material in zip(numbers, scene.materials, strict=True):
            table[number + 1] = material.pass_index
        return table

    def _denoised(self, tile: Tile) -> Pixels | None:
        try:
            pixels = denoise.denoised(lambda name: self._render.read(name, tile))
        except GlimmerError as error:
            self.problem = str(error)
            return None
        self.denoised = True
        return pixels

    def _material_names(self, scene: SceneDescription) -> list[str]:
        numbers = self._render.material_numbers
        names = [""] * (max(numbers, default=-1) + 1)
        for number, material in zip(numbers, scene.materials, strict=True):
            names[number] = material.name
        return names

    def metadata(self) -> list[tuple[str, str]]:
        """(name, value) of what the file has to say about the passes."""
        found: list[tuple[str, str]] = []
        for kind in cryptomatte.KINDS:
            if any(item.matte == kind for item in self._passes):
                names = sorted({name for name in self._names.of(kind) if name})
                found += cryptomatte.metadata(self._layer, kind, names)
        return found

    def run(self) -> None:
        """Until the render has ended or the user has cancelled it; what is there by then is kept."""
        if self._canvas is not None:
            self._show(self._whole)
        self._render.start()
        refresh_at = status_at = 0.0
        told_samples = 0
        while True:
            if self._engine.test_break():
                self._render.cancel()
            progress = self._render.poll()
            if time.monotonic() >= status_at or progress.ended:
                self._tell(progress)
                status_at = time.monotonic() + STATUS_SECONDS
                if self._watch is not None and progress.samples != told_samples:
                    told_samples = progress.samples
                    self._watch(self._render.report())
            if progress.ended:
                break
            if progress.samples > 0:
                self._canvas = None
            if time.monotonic() >= refresh_at:
                refresh_at = self._refresh()
            self._render.wait(POLL_SECONDS)
        self._render.wait(-1.0)
        if progress.samples > 0:
            self._canvas = None
        self._paint(self._render.changed_tiles())
        self._show(self._whole, final=True)

    def _tell(self, progress: Progress) -> None:
        self._engine.update_stats("", status(progress, self._settings.samples))
        self._engine.update_progress(progress.fraction)
        megabytes = progress.peak_bytes / 2**20
        self._engine.update_memory_stats(memory_used=megabytes, memory_peak=megabytes)

    def _refresh(self) -> float:
        """Shows what changed. Returns when to look again."""
        start = time.monotonic()
        tiles = self._render.changed_tiles()
        if not tiles:
            return start  # the first ones are shown as soon as they are there
        self._paint(tiles)
        for tile in tiles if len(tiles) <= MAX_TILES else [self._whole]:
            self._show(tile)
        end = time.monotonic()
        return end + max(REFRESH_SECONDS, (end - start) / MAX_REFRESH_SHARE)

    def _paint(self, tiles: list[Tile]) -> None:
        """Over the coarse picture, while there is one."""
        if self._canvas is None:
            return
        for tile in tiles:
            alpha = self._render.read(ALPHA, tile) if self._has_alpha else None
            pixels = with_alpha(self._render.read(COMBINED.engine_name, tile), alpha)
            self._canvas[tile.y : tile.y + tile.height, tile.x : tile.x + tile.width] = pixels

    def _part_of_canvas(self, tile: Tile) -> Pixels | None:
        if self._canvas is None:
            return None
        return self._canvas[tile.y : tile.y + tile.height, tile.x : tile.x + tile.width]

    def _show(self, tile: Tile, final: bool = False) -> None:
        result = self._engine.begin_result(
            tile.x,
            self._whole.height - tile.y - tile.height,
            tile.width,
            tile.height,
            layer=self._layer,
            view=self._view,
        )
        try:
            if (result.resolution_x, result.resolution_y) != (tile.width, tile.height):
                raise GlimmerError(
                    f"Blender expects {result.resolution_x} x {result.resolution_y} pixels where the engine rendered"
                    f" {tile.width} x {tile.height}: a defect of the add-on, please report it with the border's numbers"
                )
            self._fill(result.layers[0].passes, tile, final)
        finally:
            self._engine.end_result(result)

    def _fill(self, layer_passes: Any, tile: Tile, final: bool) -> None:
        reader = Reader(
            lambda name: self._render.read(name, tile),
            self._has_alpha,
            self._material_indices,
            self._to_camera,
            self._names,
            self._denoised(tile) if final and self._denoises and self._canvas is None else None,
            self._part_of_canvas(tile),
        )
        asked = [(item.name, item.channels) for item in layer_passes]
        layer_passes.foreach_set("rect", hand_over(asked, self._passes, (tile.height, tile.width), reader, final))
