# SPDX-License-Identifier: GPL-3.0-or-later
"""The error of a picture against its render time, as a table and as a small log-log plot.

Drawn by numpy alone: Blender brings nothing that plots, and the panel wants it anew at every doubling of the samples.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import ceil, floor, isfinite, log10
from typing import Any

import numpy as np
from numpy.typing import NDArray

Pixels = NDArray[np.uint8]  # (height, width, 3), top row first
Color = tuple[int, int, int]

HEADER = "seconds,cpu_seconds,spp,relmse,low,high"  # as the command line's --curve

BACKGROUND, FRAME, GRID, MINOR = (250, 250, 250), (60, 60, 60), (205, 205, 205), (232, 232, 232)
BAND, LINE, GUIDE, TEXT = (190, 212, 240), (25, 90, 180), (150, 150, 150), (60, 60, 60)
MARGIN_LEFT, MARGIN_RIGHT, MARGIN_TOP, MARGIN_BOTTOM = 52, 14, 26, 40
TEXT_SCALE = 2

# 3 x 5 pixels each, a row an octal digit: what labels here need.
GLYPHS = {
    "0": 0o75557, "1": 0o26227, "2": 0o71747, "3": 0o71717, "4": 0o55711, "5": 0o74717, "6": 0o74757, "7": 0o71122,
    "8": 0o75757, "9": 0o75717, ".": 0o00002, "-": 0o00700, "e": 0o02746, "R": 0o65655, "E": 0o74747, "L": 0o44447,
    "M": 0o57755, "S": 0o34216, "C": 0o34443, "O": 0o25552, "N": 0o65555, "D": 0o65556, "/": 0o11244, "T": 0o72222,
    "I": 0o72227, " ": 0o00000, "P": 0o65644,
}  # fmt: skip


@dataclass(frozen=True)
class Point:
    seconds: float
    cpu_seconds: float
    samples: int
    relmse: float
    low: float | None  # of its interval, where that is known
    high: float | None


def points_of(report: dict[str, Any]) -> list[Point]:
    """Those of a render's report whose error is known."""
    return [Point(*row) for row in report.get("curve", []) if row[3] is not None and isfinite(row[3])]


def table(points: Sequence[Point]) -> str:
    def cell(value: float | None) -> str:
        return "" if value is None else f"{value:.9g}"

    rows = [(p.seconds, p.cpu_seconds, p.samples, p.relmse, p.low, p.high) for p in points]
    return "\n".join([HEADER, *(",".join(map(cell, row)) for row in rows)]) + "\n"


@dataclass(frozen=True)
class LogAxis:
    """Whole decades, on pixels first to last."""

    low: int  # powers of ten
    high: int
    first: int
    last: int

    def __call__(self, value: float) -> int:
        at = (log10(value) - self.low) / (self.high - self.low)
        return round(self.first + min(max(at, 0.0), 1.0) * (self.last - self.first))


def axis(values: Sequence[float], first: int, last: int) -> LogAxis:
    low, high = floor(log10(min(values))), ceil(log10(max(values)))
    return LogAxis(low, max(high, low + 1), first, last)


def plot(points: Sequence[Point], width: int = 480, height: int = 320) -> Pixels:
    """With the interval as a band and, dashed from the last point, what falling as 1/time would be."""
    pixels: Pixels = np.empty((height, width, 3), np.uint8)
    pixels[:] = BACKGROUND
    shown = [point for point in points if point.seconds > 0.0 and point.relmse > 0.0]
    left, right, top, bottom = MARGIN_LEFT, width - MARGIN_RIGHT, MARGIN_TOP, height - MARGIN_BOTTOM
    if not shown:
        _text(pixels, "NO RELMSE", width // 2, height // 2, 0.5)
        return pixels
    x = axis([p.seconds for p in shown], left, right)
    # An interval that reaches far beyond the curve may leave the picture.
    most = 10.0 * max(p.relmse for p in shown)
    bounds = [min(bound, most) for p in shown for bound in (p.low, p.high) if bound is not None and bound > 0.0]
    y = axis([p.relmse for p in shown] + bounds, bottom, top)
    _axes(pixels, x, y)
    for a, b in pairwise(shown):
        _band(pixels, a, b, x, y)
    _guide(pixels, shown[-1], x, y)
    for a, b in pairwise(shown):
        _line(pixels, (x(a.seconds), y(a.relmse)), (x(b.seconds), y(b.relmse)), LINE, 2)
    for point in shown:
        column, row = x(point.seconds), y(point.relmse)
        pixels[row - 3 : row + 4, column - 3 : column + 4] = LINE
    return pixels


def _axes(pixels: Pixels, x: LogAxis, y: LogAxis) -> None:
    left, right, bottom, top = x.first, x.last, y.first, y.last
    for scale in (x, y):
        for power in range(scale.low, scale.high + 1):
            for factor in range(1, 10) if power < scale.high else (1,):
                at, color = scale(factor * 10.0**power), GRID if factor == 1 else MINOR
                if scale is x:
                    pixels[top : bottom + 1, at] = color
                else:
                    pixels[at, left : right + 1] = color
    for power in range(x.low, x.high + 1):
        _text(pixels, _label(power), x(10.0**power), bottom + 8, 0.5)
    for power in range(y.low, y.high + 1):
        _text(pixels, _label(power), left - 6, y(10.0**power) - 5, 1.0)
    pixels[bottom, left : right + 1] = FRAME
    pixels[top : bottom + 1, left] = FRAME
    _text(pixels, "SECONDS", (left + right) // 2, bottom + 24, 0.5)
    _text(pixels, "RELMSE", 4, 8, 0.0)


def _label(power: int) -> str:
    return f"{10.0**power:g}" if -3 <= power <= 4 else f"1e{power}"


def _band(pixels: Pixels, a: Point, b: Point, x: LogAxis, y: LogAxis) -> None:
    if a.low is None or a.high is None or b.low is None or b.high is None:
        return
    tiny = 10.0**y.low
    first, last = x(a.seconds), x(b.seconds)
    for column in range(first, last + 1):
        t = (column - first) / max(last - first, 1)
        upper = y(max(a.high, tiny)) * (1 - t) + y(max(b.high, tiny)) * t
        lower = y(max(a.low, tiny)) * (1 - t) + y(max(b.low, tiny)) * t
        pixels[round(upper) : round(lower) + 1, column] = BAND


def _guide(pixels: Pixels, last: Point, x: LogAxis, y: LogAxis) -> None:
    for column in range(x.first, x.last + 1):
        seconds = 10.0 ** (x.low + (column - x.first) / (x.last - x.first) * (x.high - x.low))
        error = last.relmse * last.seconds / seconds
        if column % 12 < 7 and 10.0**y.low < error < 10.0**y.high:
            pixels[y(error), column] = GUIDE


def _line(pixels: Pixels, a: tuple[int, int], b: tuple[int, int], color: Color, thickness: int) -> None:
    steps = 2 * max(abs(b[0] - a[0]), abs(b[1] - a[1])) + 1
    columns = np.linspace(a[0], b[0], steps).round().astype(int)
    rows = np.linspace(a[1], b[1], steps).round().astype(int)
    for i in range(thickness):
        for j in range(thickness):
            pixels[rows + i, columns + j] = color


def _text(pixels: Pixels, text: str, x: int, y: int, align: float) -> None:
    """align: 0, the text begins at x; 0.5, it is centred there; 1, it ends there."""
    height, width = pixels.shape[:2]
    x -= round(align * (4 * len(text) - 1) * TEXT_SCALE)
    for index, letter in enumerate(text):
        bits = GLYPHS[letter]
        for row in range(5):
            for column in range(3):
                if bits >> (3 * (4 - row) + 2 - column) & 1:
                    top, left = y + row * TEXT_SCALE, x + (4 * index + column) * TEXT_SCALE
                    if 0 <= top < height and 0 <= left < width:
                        pixels[top : top + TEXT_SCALE, left : left + TEXT_SCALE] = TEXT
