# SPDX-License-Identifier: GPL-3.0-or-later
"""A coarse picture, to be seen at once: the same view in fewer, larger pixels."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..native.render import Tile, open_render
from ..scene.description import RenderSettings, SceneDescription
from .passes import ALPHA, with_alpha

Pixels = NDArray[np.float32]
Window = tuple[int, int, int, int]  # x0, y0, x1, y1 from the top left

SCALE = 8  # pixels of a final picture in a row that are one at first
LEAST_PIXELS = 256 * 256  # a picture that is smaller is as quick without
MOST_SECONDS = 3.0  # that the picture itself may wait for it
POLL_SECONDS = 0.05


def reduced(scene: SceneDescription, scale: int) -> SceneDescription:
    """The same view in pixels of `scale` by `scale` as large."""
    film = scene.film
    width, height = -(-film.width // scale), -(-film.height // scale)
    crop = film.crop
    if crop is not None:
        crop = crop[0] // scale, crop[1] // scale, -(-crop[2] // scale), -(-crop[3] // scale)
    return replace(scene, film=replace(film, width=width, height=height, crop=crop))


def enlarged(pixels: Pixels, of: Window, scale: int, window: Window) -> Pixels:
    """A coarse picture's window in pixels of a film `scale` times as large, cut to a window of that. Top rows first."""
    x0, y0 = of[0] * scale, of[1] * scale
    rows = pixels.repeat(scale, axis=0).repeat(scale, axis=1)
    return np.ascontiguousarray(rows[window[1] - y0 : window[3] - y0, window[0] - x0 : window[2] - x0])


def first_look(scene: SceneDescription, is_cancelled: Callable[[], bool]) -> Pixels | None:
    """(height, width, 4) of the film's window, top row first, from one sample of each coarse pixel. None where it does
    not help, takes too long or was cancelled."""
    x0, y0, x1, y1 = scene.film.window
    if (x1 - x0) * (y1 - y0) < LEAST_PIXELS:
        return None
    settings = RenderSettings(
        integrator=scene.settings.integrator,
        samples=1,
        seed=scene.settings.seed,
        threads=scene.settings.threads,
        max_depth=scene.settings.max_depth,
        max_scatter=scene.settings.max_scatter,
    )
    small = replace(reduced(scene, SCALE), settings=settings)
    end = time.monotonic() + MOST_SECONDS
    render, _ = open_render(small)
    with render:
        render.start()
        while not render.poll().ended:
            if is_cancelled() or time.monotonic() > end:
                return None
            render.wait(POLL_SECONDS)
        left, top, right, bottom = small.film.window
        whole = Tile(0, 0, right - left, bottom - top)
        alpha = render.read(ALPHA, whole) if render.has_alpha else None
        pixels = with_alpha(render.read("combined", whole), alpha)
    return enlarged(pixels, small.film.window, SCALE, scene.film.window)
