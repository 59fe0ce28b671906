# SPDX-License-Identifier: GPL-3.0-or-later
"""Linear pixels drawn over a region; Blender turns them to the display's colours."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

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

    def set(self, pixels: NDArray[np.float32]) -> None:
        """pixels: (height, width, 3), top row first."""
        import gpu  # not there in background

        height, width = pixels.shape[:2]
        opaque = np.ones((height, width, 4), np.float32)
        opaque[..., :3] = pixels[::-1]  # textures begin at the bottom
        buffer = gpu.types.Buffer("FLOAT", width * height * 4, opaque.reshape(-1))
        self._texture = gpu.types.GPUTexture((width, height), format="RGBA32F", data=buffer)

    def draw(self, engine: bpy.types.RenderEngine, scene: bpy.types.Scene, size: tuple[int, int]) -> None:
        """Stretched over a region of this size."""
        import gpu
        from gpu_extras.presets import draw_texture_2d

        gpu.state.blend_set("ALPHA_PREMULT")
        engine.bind_display_space_shader(scene)
        draw_texture_2d(self._texture, (0, 0), *size)
        engine.unbind_display_space_shader()
        gpu.state.blend_set("NONE")
