# SPDX-License-Identifier: GPL-3.0-or-later
"""The error against time: its table, its plot and its words."""

from math import log10
from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO
import pytest
from numpy.typing import NDArray
from scipy import ndimage

from addon.film import noise
from addon.film.display import status
from addon.film.png import write_png
from addon.film.stamp import fields
from addon.native import error_curve, structs
from addon.native.library import Library
from addon.native.render import Progress
from addon.native.structs import State

Pixels = NDArray[np.uint8]
Row = list[float | None]

ROWS: list[Row] = [[0.05 * 4**i, 0.1 * 4**i, 2**i, 0.8 / 4**i, 0.6 / 4**i, 1.2 / 4**i] for i in range(5)]
NOT_KNOWN: Row = [0.01, 0.02, 1, None, None, None]
DARK = error_curve.PlotColors((0.2, 0.2, 0.2), (0.9, 0.9, 0.9), (0.2, 0.4, 0.8))


@pytest.fixture(scope="module")
def library(library_dir: Path) -> Library:
    return Library(library_dir / "libglimmer.so")


def report(*rows: Row) -> dict[str, Any]:
    return {"curve": list(rows)}


def is_color(pixels: Pixels, color: error_curve.Color) -> NDArray[np.bool_]:
    difference: NDArray[np.bool_] = (np.abs(pixels - 255 * np.array(color)) <= 1).all(axis=2)
    return difference


def marks(pixels: Pixels, color: error_curve.Color) -> NDArray[np.float64]:
    """The middles of the points, (n, column and row), from left to right: the line is narrower than 3 pixels."""
    inside, count = ndimage.label(ndimage.binary_erosion(is_color(pixels, color), np.ones((3, 3))))
    middles = ndimage.center_of_mass(inside > 0, inside, range(1, count + 1))
    return np.array(sorted((column, row) for row, column in middles))


def test_only_points_with_a_known_error_count(library: Library) -> None:
    assert error_curve.has_points(report(NOT_KNOWN, *ROWS)) and not error_curve.has_points(report(NOT_KNOWN))
    assert not error_curve.has_points({})
    assert error_curve.table(library, report(NOT_KNOWN)) == error_curve.table(library, {})


def test_the_table_is_that_of_the_command_line(library: Library) -> None:
    text = error_curve.table(library, report([0.25, 0.5, 2, 0.125, None, None], [0.5, 1.0, 4, 0.0625, 0.05, 0.1]))
    assert text == "seconds,cpu_seconds,spp,relmse,low,high\n0.25,0.5,2,0.125,,\n0.5,1,4,0.0625,0.05,0.1\n"


@pytest.mark.parametrize("size", [(320, 320), (480, 320), (960, 600)])
def test_the_marks_lie_where_their_logarithms_are(library: Library, size: tuple[int, int]) -> None:
    found = marks(error_curve.plot(library, report(NOT_KNOWN, *ROWS), size, DARK), DARK.line)
    if size[0] >= 600:
        found = np.array([mark for mark in found if mark[0] < size[0] - 220 or mark[1] > 120])  # not the legend's
    assert len(found) == len(ROWS)
    columns, rows = found.T
    decades_x = np.log10([row[0] for row in ROWS if row[0]])
    decades_y = np.log10([row[3] for row in ROWS if row[3]])
    across, down = np.polyfit(decades_x, columns, 1), np.polyfit(decades_y, rows, 1)
    np.testing.assert_allclose(np.polyval(across, decades_x), columns, atol=0.6)
    np.testing.assert_allclose(np.polyval(down, decades_y), rows, atol=0.6)
    assert across[0] > size[0] / 8 and down[0] < -size[1] / 8, "the curve does not fill the plot"


def test_the_band_spans_the_interval(library: Library) -> None:
    pixels = error_curve.plot(library, report(*ROWS), (480, 320), DARK)
    found = marks(pixels, DARK.line)
    column = int(found[1][0] + found[2][0]) // 2
    band = (0.2, 0.2 + 0.3 * 0.2, 0.2 + 0.3 * 0.6)
    rows = np.flatnonzero(is_color(pixels, band)[:, column])
    per_decade = (found[2][1] - found[1][1]) / log10(4)
    assert rows.max() + 1 - rows.min() == pytest.approx(log10(1.2 / 0.6) * per_decade, abs=2)


def test_ticks_tell_the_values(library: Library) -> None:
    """The same curve, a thousand times as slow, differs in the numbers below the axis alone."""
    slow: list[Row] = [[1000 * (row[0] or 0), *row[1:]] for row in ROWS]
    a, b = (error_curve.plot(library, report(*rows), (480, 320)).astype(int) for rows in (ROWS, slow))
    different = np.flatnonzero((np.abs(a - b) > 1).any(axis=(1, 2)))
    assert different.min() > 250 and different.max() < 300 and 8 <= len(different) <= 13
    left = (a[40:250, :50] < 200).all(axis=2)
    assert left.any(), "no numbers beside the axis"


def test_a_plot_without_points_says_so(library: Library) -> None:
    pixels = error_curve.plot(library, report(NOT_KNOWN), (320, 320), DARK)
    assert not is_color(pixels, DARK.line).any()
    written = np.flatnonzero(~is_color(pixels, DARK.background).all(axis=1))
    assert written.min() > 140 and written.max() < 180


ODD: list[list[Row]] = [
    [],
    ROWS[:1],
    [[1e-9, 1e-9, 1, 1e-12, None, None], *ROWS],
    [[1e-300, 1, 1, 1e-300, 0, 1e300], [1e300, 1, 1e300, 1e300, 1e300, 0]],
    [[0, 0, 1, 0.5, None, None], [1, 1, 1, 0, 0, 0]],
    [[5, 5, 4, 0.5, 0.1, 1], [5, 5, 4, 0.5, 0.1, 1], [4, 4, 4, 0.5, 0.1, 1]],
]


@pytest.mark.parametrize("rows", ODD)
@pytest.mark.parametrize("size", [(200, 200), (640, 200), (200, 1000)])
def test_odd_curves_are_drawn_too(library: Library, rows: list[Row], size: tuple[int, int]) -> None:
    pixels = error_curve.plot(library, report(*rows), size, DARK)
    assert pixels.shape == (size[1], size[0], 3)
    assert is_color(pixels, DARK.background).mean() > 0.5 and not is_color(pixels, DARK.background).all()


def test_without_size_and_colors_it_is_the_librarys_own(library: Library) -> None:
    desc = library.init(structs.PlotDesc)
    pixels = error_curve.plot(library, report(*ROWS))
    assert pixels.shape == (desc.height, desc.width, 3)
    assert (pixels[0] == 255).all() and is_color(pixels, tuple(desc.line)).any()


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
    assert "Sample 64/128 | 50 % | Left 00:08 | Noise 17 % (14 to 20 %)" in line
    assert "error" not in line.lower(), "the managers of render farms take such a line for a failure"
    assert "Noise limit in 00:24" in line and "Fireflies" not in line
    assert "limit" not in status(progress(seconds_to_target=None), 128)
    assert "Fireflies" in status(progress(heavy_tails=True), 128)


def test_noise_is_the_root_of_the_error() -> None:
    assert noise.percent(0.0009) == pytest.approx(3.0)
    assert noise.relmse_of(noise.percent(0.0123)) == pytest.approx(0.0123)
    assert noise.noise_text(1e-4) == "1 %" and noise.noise_text(2.25) == "150 %"
    assert [noise.word_for(noise.relmse_of(p)) for p in (0.5, 2.0, 5.0, 20.0, 80.0)] == [
        word for _, word in noise.WORDS
    ]


@pytest.mark.parametrize("power", [1.0, 0.6, 1.4])
def test_half_the_noise_takes_a_quarter_of_the_error(power: float) -> None:
    """Of an error that falls as a power of the time."""
    seconds = 30.0
    to_half = seconds * (2.0 ** (1.0 / power) - 1.0)
    found = noise.seconds_to_half_the_noise(seconds, to_half)
    assert ((seconds + found) / seconds) ** -power == pytest.approx(0.25)


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
