# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of photometric data: what they say by direction, and that bad ones are refused in a line."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from addon.export.translate.ies import COLUMNS, ROWS, WATTS, parse, picture


def file(down: list[float], around: list[float], candela: NDArray[Any], tilt: str = "NONE", kind: int = 1) -> str:
    tilted = "INCLUDE\n1\n2\n0 90\n1 1" if tilt == "INCLUDE" else tilt
    rows = "\n".join(" ".join(f"{value:.6g}" for value in row) for row in candela)
    return (
        f"IESNA:LM-63-2002\n[TEST] none\nTILT={tilted}\n1 1000 2 {len(down)} {len(around)} {kind} 2 0 0 0\n"
        f"0.5 0.8 100\n{' '.join(map(str, down))}\n{' '.join(map(str, around))}\n{rows}\n"
    )


DOWN = np.linspace(0, 90, 19)
FACTOR = 2 * 0.5 * 0.8 * WATTS  # multiplier, ballast, ballast and lamp


def at(pixels: NDArray[Any], down: float, around: float) -> float:
    return float(pixels[round(down / 180 * ROWS - 0.5), round(around / 360 * COLUMNS - 0.5) % COLUMNS, 0])


@pytest.mark.parametrize("tilt", ["NONE", "INCLUDE"])
def test_a_round_lamp(tilt: str) -> None:
    """A cosine, which cubics follow to a thousandth; nothing beyond the last angle."""
    pixels = picture(parse(file(list(DOWN), [0], np.cos(np.radians(DOWN))[None] * 1000, tilt)))
    for down in (0.2, 7, 31.3, 60, 88):
        expected = 1000 * FACTOR * np.cos(np.radians(down))
        assert [at(pixels, down, around) for around in (0.5, 100, 359)] == pytest.approx(
            [expected] * 3, rel=0.01, abs=1
        )
    assert at(pixels, 91, 10) == 0


@pytest.mark.parametrize(("end", "first"), [(90, 0), (180, 0), (330, 0), (270, 90)])
def test_a_part_of_what_is_symmetric(end: int, first: int) -> None:
    """The cosine of twice the angle has all these symmetries; from 90 to 270 degrees the file is turned."""
    around = np.arange(first, end + 1, 15)
    candela = 500 + 300 * np.cos(np.radians(2 * (around - first)))[:, None] * np.ones(len(DOWN))
    pixels = picture(parse(file(list(DOWN), list(around), candela)))
    for degrees in (3, 50, 122, 200, 301, 352):
        expected = (500 + 300 * np.cos(np.radians(2 * degrees))) * FACTOR
        assert at(pixels, 40, degrees) == pytest.approx(expected, rel=0.02)


GOOD = file(list(DOWN), [0], np.ones((1, 19)))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "no TILT="),
        (GOOD[:60], "too early"),
        (GOOD.replace("1000", "many"), "a number was expected"),
        (GOOD[:-20], "too early"),
        (file(list(DOWN), [0], np.ones((1, 19)), kind=2), "type A or B"),
        (file(list(DOWN[::-1]), [0], np.ones((1, 19))), "do not rise"),
        (file(list(DOWN), [30, 60], np.ones((2, 19))), "do not begin at 0"),
        (GOOD.replace(" 19 1 ", " 99999999 1 "), "allowed: 2 to 10000"),
        (GOOD.replace(" 19 1 ", " nan 1 "), "whole number"),
    ],
)
def test_a_bad_file_is_refused(text: str, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        parse(text)
