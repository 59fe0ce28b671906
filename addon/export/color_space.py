# SPDX-License-Identifier: GPL-3.0-or-later
"""The colour spaces of images, as Blender's own colour management reads them."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .color import srgb_to_linear

# Whose numbers are no colours, and whose colours are linear already.
DATA_SPACES = ("Non-Color", "Raw", "Generic Data", "Non-Colour Data")
LINEAR_SPACES = ("Linear", "Linear Rec.709")
SRGB = "sRGB"


def is_known(space: str) -> bool:
    """Whether its colours are made linear without Blender's help."""
    return space in (*DATA_SPACES, *LINEAR_SPACES, SRGB)


def to_linear(colors: NDArray[np.float32], space: str) -> NDArray[np.float32]:
    """(height, width, 3) of encoded colours, 0 to 1 -> linear light. Raises RuntimeError where Blender cannot."""
    if space in (*DATA_SPACES, *LINEAR_SPACES):
        return colors
    return srgb_to_linear(colors) if space == SRGB else _by_blender(colors, space)


def _by_blender(colors: NDArray[np.float32], space: str) -> NDArray[np.float32]:
    """Blender makes floats linear when it reads them from a file, so they are written to one."""
    import bpy

    height, width = colors.shape[:2]
    with tempfile.TemporaryDirectory() as folder:
        path = str(Path(folder) / "colors.exr")
        written = bpy.data.images.new("Colors", width, height, alpha=False, float_buffer=True, is_data=True)
        try:
            opaque = np.concatenate([colors, np.ones((height, width, 1))], axis=2, dtype=np.float32)
            written.pixels.foreach_set(opaque.ravel())
            written.filepath_raw, written.file_format = path, "OPEN_EXR"
            written.save()
        finally:
            bpy.data.images.remove(written)
        read = bpy.data.images.load(path, check_existing=False)
        try:
            read.colorspace_settings.name = space
            pixels = np.empty(width * height * read.channels, np.float32)
            read.pixels.foreach_get(pixels)
        finally:
            bpy.data.images.remove(read)
    return pixels.reshape(height, width, -1)[..., :3]
