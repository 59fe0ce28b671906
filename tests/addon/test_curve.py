# SPDX-License-Identifier: GPL-3.0-or-later
"""The error against time: its table, its plot and its words."""

from math import log10
from pathlib import Path

import numpy as np
import OpenImageIO
import pytest

from addon.film.curve import BAND, GLYPHS, LINE, Pixels, Point, _label, axis, plot, points_of, table
from addon.film.display import status
from addon.film.png import write_png
from addon.film.stamp import fields
from addon.native.render import Progress
from addon.native.structs import State

POINTS = [Point(0.05 * 4**i, 0.1 * 4**i, 2**i, 0.8 / 4**i, 0.6 / 4**i, 1.2 / 4**i) for i in range(5)]


def test_points_are_those_with_a_known_error() -> None:
    report = {"curve": [[0.1, 0.2, 1, None, None, None], [0.2, 0.4, 2, 0.5, None, None], [0.3, 0.6, 4, 0.3, 0.2, 0.4]]}
    assert points_of(report) == [Point(0.2, 0.4, 2, 0.5, None, None), Point(0.3, 0.6, 4, 0.3, 0.2, 0.4)]
    assert points_of({}) == []


def test_the_table_is_that_of_the_command_line() -> None:
    text = table([Point(0.25, 0.5, 2, 0.125, None, None), Point(0.5, 1.0, 4, 0.0625, 0.05, 0.1)])
    assert text == "seconds,cpu_seconds,spp,relmse,low,high\n0.25,0.5,2,0.125,,\n0.5,1,4,0.0625,0.05,0.1\n"


def test_an_axis_holds_its_values_in_whole_decades() -> None:
    scale = axis([0.03, 40.0], 100, 500)
    assert (scale.low, scale.high) == (-2, 2)
    assert [scale(value) for value in (0.01, 1.0, 100.0)] == [100, 300, 500]
    assert axis([1.0], 0, 9).high > axis([1.0], 0, 9).low


def centers(pixels: Pixels) -> list[tuple[int, int]]:
    """Of the squares that mark the points: (column, row) where 7 x 7 pixels are of the line's colour."""
    blue = (pixels == LINE).all(axis=2)
    found: list[tuple[int, int]] = []
    for row in range(3, blue.shape[0] - 3):
        for column in range(3, blue.shape[1] - 3):
            if blue[row - 3 : row + 4, column - 3 : column + 4].all():
                found.append((column, row))
    return found


def test_the_marks_lie_on_a_line_of_slope_minus_one_decade_a_decade() -> None:
    marks = sorted(centers(plot(POINTS)))
    assert len(marks) == len(POINTS)
    # 0.05 to 12.8 s on [0.01, 100], 0.003 to 1.2 on [0.001, 10]: pixels a decade differ, the marks tell both.
    columns, rows = np.array(marks, float).T
    decades_x = np.log10([p.seconds for p in POINTS])
    decades_y = np.log10([p.relmse for p in POINTS])
    across, down = np.polyfit(decades_x, columns, 1), np.polyfit(decades_y, rows, 1)
    np.testing.assert_allclose(np.polyval(across, decades_x), columns, atol=0.6)
    np.testing.assert_allclose(np.polyval(down, decades_y), rows, atol=0.6)
    assert across[0] > 0 > down[0]


def test_the_band_spans_the_interval() -> None:
    pixels = plot(POINTS, 480, 320)
    marks = sorted(centers(pixels))
    column = (marks[1][0] + marks[2][0]) // 2
    rows = np.flatnonzero((pixels[:, column] == BAND).all(axis=1))
    per_decade = (marks[2][1] - marks[1][1]) / log10(POINTS[1].relmse / POINTS[2].relmse)
    assert rows.max() - rows.min() == pytest.approx(log10(1.2 / 0.6) * per_decade, abs=3)


@pytest.mark.parametrize("points", [[], POINTS[:1], [Point(1e-9, 1e-9, 1, 1e-12, None, None), *POINTS]])
def test_odd_curves_are_drawn_too(points: list[Point]) -> None:
    assert plot(points, 320, 320).shape == (320, 320, 3)


def test_there_is_a_glyph_for_every_label() -> None:
    assert all(letter in GLYPHS for power in range(-30, 31) for letter in _label(power))


def test_png_files_hold_the_pixels(tmp_path: Path) -> None:
    pixels = np.random.default_rng(1).integers(0, 256, (13, 7, 3), np.uint8)
    write_png(pixels, tmp_path / "x.png")
    image = OpenImageIO.ImageInput.open(str(tmp_path / "x.png"))
    assert image is not None, OpenImageIO.geterror()
    np.testing.assert_array_equal(image.read_image(0, 0, 0, 3, OpenImageIO.UINT8), pixels)


def progress(heavy_tails: bool = False, seconds_to_target: float | None = 24.0) -> Progress:
    return Progress(
        State.RUNNING,
        64,
        0.5,
        8.0,
        8.0,
        relmse=0.03,
        relmse_low=0.02,
        relmse_high=0.04,
        heavy_tails=heavy_tails,
        seconds_to_target=seconds_to_target,
    )


def test_the_status_line_tells_error_interval_and_time_to_the_target() -> None:
    line = status(progress(), 128)
    assert "Sample 64/128 | 50 % | Left 00:08 | relMSE 0.03 (0.02 to 0.04)" in line
    assert "error" not in line.lower(), "the managers of render farms take such a line for a failure"
    assert "Target in 00:24" in line and "certifiable" not in line
    assert "Target" not in status(progress(seconds_to_target=None), 128)
    assert "Not certifiable: heavy tails" in status(progress(heavy_tails=True), 128)


def test_metadata_names_its_layer_and_leaves_out_what_is_not_known() -> None:
    report = {
        "engine": "1.2.3", "integrator": "path", "spp": 1, "seed": 7, "seconds": {"render": 1.5, "cpu": 3.0},
        "biased_by": ["max_depth 4", "max_scatter 2"], "error": None,
    }  # fmt: skip
    found = dict(fields(report, "Fore"))
    assert found["glimmer.Fore.biased_by"] == "max_depth 4, max_scatter 2"
    assert found["glimmer.Fore.samples"] == "1" and found["glimmer.Fore.seconds"] == "1.5"
    assert not any("error" in name for name in found)
    assert fields({}, "Fore") == []
