# SPDX-License-Identifier: GPL-3.0-or-later
"""What is refused of the curve of the error."""

from ctypes import byref, c_char_p
from typing import Any

import numpy as np
import pytest

from addon.native import structs
from tests.engine.api.misuse import ARGUMENT, INFINITY, NAN, OK, changed, refused
from tests.engine.library import engine, functions

POINTS = (structs.CurvePoint * 2)(
    structs.CurvePoint(1, 1, 4, 0.5, NAN, NAN), structs.CurvePoint(2, 2, 8, 0.2, 0.1, 0.3)
)


def plot(changes: dict[str, Any], points: Any = POINTS, count: int = 2, out: bool = True, missing: int = 0) -> int:
    desc = changed(engine().init(structs.PlotDesc), changes)
    pixels = np.full(3 * 960 * 600, 7, np.uint8)
    data = pixels.ctypes.data if out else None
    result: int = functions().glimmer_plot_error_curve(points, count, byref(desc), data, pixels.size - missing)
    assert (result == OK) == bool((pixels != 7).any())
    return result


def test_good_ones() -> None:
    assert plot({}) == plot({}, None, 0) == plot({"background": (0, 0, 0), "text": (1, 1, 1)}) == OK


@pytest.mark.parametrize("side", ["width", "height"])
@pytest.mark.parametrize("value", [0, 199, 8193, 0xFFFFFFFF])
def test_sides(side: str, value: int) -> None:
    refused(plot({side: value}), ARGUMENT, f"plot: {side} is ", "allowed: 200 to 8192")


@pytest.mark.parametrize("color", ["background", "text", "line", "guide"])
@pytest.mark.parametrize("value", [-0.1, 1.1, NAN, INFINITY])
def test_colors(color: str, value: float) -> None:
    refused(plot({color: (0, value, 0)}), ARGUMENT, f"plot: {color} is ", "allowed: 0 to 1")


def test_arrays() -> None:
    refused(plot({}, None), ARGUMENT, "points are null")
    refused(plot({}, out=False), ARGUMENT, "the output is null", "1728000 bytes")
    refused(plot({}, missing=1), ARGUMENT, "1727999 bytes", "allowed: 1728000 bytes")
    refused(functions().glimmer_plot_error_curve(POINTS, 2, None, None, 0), ARGUMENT, "description is null")
    refused(plot({"struct_size": 1}), ARGUMENT, "plot: struct_size is 1")


def test_tables() -> None:
    table = c_char_p()
    write = functions().glimmer_error_curve_table
    refused(write(None, 1, byref(table)), ARGUMENT, "points are null")
    refused(write(POINTS, 2, None), ARGUMENT, "the output is null")
    assert table.value is None
    assert write(None, 0, byref(table)) == OK and table.value == b"seconds,cpu_seconds,spp,relmse,low,high\n"
    assert write(POINTS, 1, byref(table)) == OK and table.value and table.value.endswith(b"\n1,1,4,0.5,,\n")
