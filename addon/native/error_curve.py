# SPDX-License-Identifier: GPL-3.0-or-later
"""The error of a picture against its render time, as the engine writes and draws it."""

from __future__ import annotations

from ctypes import Array, byref, c_char_p, c_void_p
from math import isfinite, nan
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import structs
from .library import Library

Color = tuple[float, float, float]  # sRGB, 0 to 1


class PlotColors(NamedTuple):
    background: Color
    text: Color
    line: Color


def has_points(report: dict[str, Any]) -> bool:
    """Whether the error is known at any point of a render's report."""
    return bool(_rows(report))


def table(library: Library, report: dict[str, Any]) -> str:
    """The points whose error is known as CSV, after a line of names."""
    points = _points(report)
    text = c_char_p()
    library.call("glimmer_error_curve_table", points, len(points), byref(text))
    return (text.value or b"").decode()


def plot(
    library: Library, report: dict[str, Any], size: tuple[int, int] | None = None, colors: PlotColors | None = None
) -> NDArray[np.uint8]:
    """(height, width, 3) sRGB, top row first. size: (width, height) in pixels. Without size and colours it is what the
    command line's --curve draws."""
    desc = library.init(structs.PlotDesc)
    if size is not None:
        desc.width, desc.height = size
    if colors is not None:
        desc.background, desc.text, desc.line = colors
    points = _points(report)
    pixels = np.empty((desc.height, desc.width, 3), np.uint8)
    out = pixels.ctypes.data_as(c_void_p)
    library.call("glimmer_plot_error_curve", points, len(points), byref(desc), out, pixels.size)
    return pixels


def _rows(report: dict[str, Any]) -> list[list[float | None]]:
    return [row for row in report.get("curve", []) if row[3] is not None and isfinite(row[3])]


def _points(report: dict[str, Any]) -> Array[structs.CurvePoint]:
    rows = _rows(report)
    numbers = ([nan if value is None else value for value in row] for row in rows)
    return (structs.CurvePoint * len(rows))(*(structs.CurvePoint(*row) for row in numbers))
