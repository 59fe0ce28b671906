# SPDX-License-Identifier: GPL-3.0-or-later
"""What the add-on makes of an object's places at a few moments."""

from math import cos, pi, sin

import numpy as np
import pytest
from numpy.typing import NDArray

from addon.export.motion import (
    MOST_TURN,
    Shutter,
    inverse,
    moves_as_one,
    shutter_interval,
    shutter_warp,
    smooth_motion,
)

EVEN = Shutter(0.0, 1.0)


def turned(angle: float, stretch: float = 1.0, place: float = 0.0, mirror: float = 1.0) -> NDArray[np.float64]:
    """About an axis between x and z, by half of it each way from where things are largest; stretched along y first."""
    x, z = sin(0.3), cos(0.3)
    k = np.array([[0, -z, 0], [z, 0, -x], [0, x, 0]])
    result = np.eye(4)
    result[:3, :3] = (np.eye(3) + sin(angle) * k + (1 - cos(angle)) * k @ k) @ np.diag([mirror, stretch, 1.0])
    result[0, 3] = place
    return result


@pytest.mark.parametrize(("position", "interval"), [("START", (7.0, 7.5)), ("CENTER", (6.75, 7.25)), ("END", (6.5, 7))])
def test_when_the_shutter_is_open(position: str, interval: tuple[float, float]) -> None:
    assert shutter_interval(7.0, 0.5, position) == interval


def test_what_does_not_turn_needs_nothing_between() -> None:
    steps = np.stack([turned(0.4, 1.0, 0.0), turned(0.4, 1.0, 2.0), turned(0.4, 3.0, 2.0)])[:, None]
    assert smooth_motion(steps, EVEN) is steps


@pytest.mark.parametrize("mirror", [1.0, -1.0])
def test_turns_are_round(mirror: float) -> None:
    """Nearly half a turn in each of two intervals, of another one that keeps still as well."""
    steps = np.stack([[turned(a, s, p, mirror), np.eye(4)] for a, s, p in ((0, 1, 0), (3, 2, 1), (2, 3, 4))])
    smooth = smooth_motion(steps, EVEN)
    assert (len(smooth) - 1) % 2 == 0
    np.testing.assert_allclose(smooth[:, 1], np.tile(np.eye(4), (len(smooth), 1, 1)), atol=1e-12)
    t = np.linspace(0, 2, len(smooth))
    expected = [
        turned(float(a), float(s), float(p), mirror)
        for a, s, p in zip(
            np.interp(t, [0, 1, 2], [0, 3, 2]),
            np.interp(t, [0, 1, 2], [1, 2, 3]),
            np.interp(t, [0, 1, 2], [0, 1, 4]),
            strict=True,
        )
    ]
    np.testing.assert_allclose(smooth[:, 0], expected, atol=1e-9)
    assert 3.0 / (len(smooth) - 1) * 2 <= MOST_TURN


def test_a_shutter_that_opens_gradually() -> None:
    """Open as t: half of the light is in at sqrt(1/2)."""
    warp = shutter_warp(np.linspace(0.0, 1.0, 1025))
    assert warp is not None
    np.testing.assert_allclose(warp, np.sqrt(np.linspace(0.0, 1.0, len(warp))), atol=2e-3)
    steps = np.stack([turned(0.0, 1.0, place) for place in (0.0, 1.0)])[:, None]
    smooth = smooth_motion(steps, Shutter(0.0, 1.0, warp))
    np.testing.assert_allclose(smooth[:, 0, 0, 3], warp, atol=1e-12)


@pytest.mark.parametrize("weights", [np.ones(9), np.zeros(9)])
def test_a_shutter_that_opens_at_once(weights: NDArray[np.float64]) -> None:
    assert shutter_warp(weights) is None


def test_what_moves_as_one() -> None:
    middle = np.stack([turned(0.1, 2.0, 1.0), turned(0.7, 0.5, -4.0), turned(2.0)])
    motion = np.stack([turned(a, 1.0, a) for a in (-1.0, 0.0, 1.0)])
    steps = motion[:, None] @ middle
    found = moves_as_one(steps, middle)
    assert found is not None
    np.testing.assert_allclose(found, motion, atol=1e-9)
    steps[1, 2, 0, 3] += 0.01
    assert moves_as_one(steps, middle) is None


def test_inverse() -> None:
    matrix = turned(pi / 3, 2.5, 4.0, -1.0)
    np.testing.assert_allclose(inverse(matrix) @ matrix, np.eye(4), atol=1e-12)
