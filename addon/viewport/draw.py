# SPDX-License-Identifier: GPL-3.0-or-later
"""Linear pixels drawn over a region; Blender turns them to the display's colours."""

from __future__ import annotations

from typing import Any

import bpy

from .session import Frame, bands

MESSAGE_SIZE = 14
MESSAGE_PLACE = (60, 40)
MOST_PIXELS = 2**20  # that one redraw hands to the graphics card where it may choose


def message(text: str) -> None:
    """In place of a picture. The statistics would not do: without overlays Blender hides them."""
    import blf

    if bpy.app.version < (4, 0):
        blf.size(0, MESSAGE_SIZE, 72)
    else:
        blf.size(0, MESSAGE_SIZE)
    blf.position(0, *MESSAGE_PLACE, 0)
    blf.color(0, 1.0, 1.0, 1.0, 1.0)
    blf.draw(0, text)


class Picture:
    """Textures, one above the other. Better pixels of the same scene go into one of them a redraw: the thread that
    draws the window must not be held up."""

    def __init__(self) -> None:
        self._frame: Frame | None = None
        self._textures: list[Any] = []
        self._rows: list[tuple[int, int]] = []  # of each, from the bottom
        self._stale: list[int] = []  # those that are not of the newest frame, the longest waiting first

    @property
    def is_complete(self) -> bool:
        return not self._stale

    def set(self, frame: Frame) -> None:
        older, self._frame = self._frame, frame
        if older is not None and _shape(older) == _shape(frame):
            self._stale += [index for index in range(len(self._rows)) if index not in self._stale]
            return
        height, width = frame.rgba.shape[:2]
        self._rows = bands(height, max(MOST_PIXELS // width, 1))
        self._textures, self._stale = [None] * len(self._rows), []
        for index in range(len(self._rows)):
            self._load(index)

    def _load(self, index: int) -> None:
        import gpu  # not there in background

        assert self._frame is not None
        begin, end = self._rows[index]
        pixels = self._frame.rgba[begin:end]
        buffer = gpu.types.Buffer("FLOAT", pixels.size, pixels.reshape(-1))  # copies nothing
        size = (pixels.shape[1], pixels.shape[0])
        self._textures[index] = gpu.types.GPUTexture(size, format="RGBA32F", data=buffer)

    def draw(self, engine: bpy.types.RenderEngine, scene: bpy.types.Scene, size: tuple[int, int]) -> None:
        """The film stretched over a region of this size."""
        import gpu
        from gpu_extras.presets import draw_texture_2d

        assert self._frame is not None
        if self._stale:
            self._load(self._stale.pop(0))
        x0, _, x1, y1 = self._frame.window
        film_width, film_height = self._frame.film_size
        across, up = size[0] / film_width, size[1] / film_height
        gpu.state.blend_set("ALPHA_PREMULT")
        engine.bind_display_space_shader(scene)
        for texture, (begin, end) in zip(self._textures, self._rows, strict=True):
            place = (x0 * across, (film_height - y1 + begin) * up)
            draw_texture_2d(texture, place, (x1 - x0) * across, (end - begin) * up)
        engine.unbind_display_space_shader()
        gpu.state.blend_set("NONE")


def _shape(frame: Frame) -> tuple[Any, ...]:
    return frame.scene, frame.window, frame.film_size
