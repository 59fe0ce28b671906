# SPDX-License-Identifier: GPL-3.0-or-later
"""The part of a 3D view that is rendered."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil, floor

Box = tuple[float, float, float, float]  # min_x, min_y, max_x, max_y from the bottom left


def camera_frame(corners: Sequence[tuple[float, float]]) -> Box:
    """The box around a camera's frame, in shares of the region. corners: as OpenGL clips, -1 to 1."""
    across, up = [0.5 + 0.5 * x for x, _ in corners], [0.5 + 0.5 * y for _, y in corners]
    return min(across), min(up), max(across), max(up)


def border_crop(border: Box | None, size: tuple[int, int]) -> tuple[int, int, int, int] | None:
    """x0, y0, x1, y1 in pixels from the top left. None where all is rendered, or nothing of the border is in sight."""
    if border is None:
        return None
    width, height = size
    x0, x1 = max(floor(border[0] * width), 0), min(ceil(border[2] * width), width)
    y0, y1 = max(height - ceil(border[3] * height), 0), min(height - floor(border[1] * height), height)
    return (x0, y0, x1, y1) if x1 > x0 and y1 > y0 else None
