# SPDX-License-Identifier: GPL-3.0-or-later
"""Linear pixels drawn over a region; Blender turns them to the display's colours."""

from __future__ import annotations

from typing import Any

import bpy

from .session import Frame

MESSAGE_SIZE = 14
MESSAGE_PLACE = (60, 40)


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
    def __init__(self) -> None:
        self._texture: Any = None
        self._place = (0.0, 0.0, 1.0, 1.0)  # left, bottom, width and height in the region, as shares of it

    def set(self, frame: Frame) -> None:
        import gpu  # not there in background

        height, width = frame.rgba.shape[:2]
        buffer = gpu.types.Buffer("FLOAT", width * height * 4, frame.rgba.reshape(-1))  # copies nothing
        self._texture = gpu.types.GPUTexture((width, height), format="RGBA32F", data=buffer)
        x0, _, _, y1 = frame.window
        across, up = frame.film_size
        self._place = (x0 / across, (up - y1) / up, width / across, height / up)

    def draw(self, engine: bpy.types.RenderEngine, scene: bpy.types.Scene, size: tuple[int, int]) -> None:
        """The film stretched over a region of this size."""
        import gpu
        from gpu_extras.presets import draw_texture_2d

        left, bottom, width, height = self._place
        gpu.state.blend_set("ALPHA_PREMULT")
        engine.bind_display_space_shader(scene)
        draw_texture_2d(self._texture, (left * size[0], bottom * size[1]), width * size[0], height * size[1])
        engine.unbind_display_space_shader()
        gpu.state.blend_set("NONE")
