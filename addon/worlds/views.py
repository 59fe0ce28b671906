# SPDX-License-Identifier: GPL-3.0-or-later
"""Where cameras look best and how they fly: plain numpy, no Blender in here."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, pi, sin

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
_HEADINGS = 72


@dataclass(frozen=True)
class Light:
    """A moon as the eye sees it: azimuth to the left of +y, elevation and angular radius, in radians."""

    azimuth: float
    elevation: float
    radius: float


def best_heading(moons: Sequence[Light], half_width: float) -> float:
    """To the left of +y: where the picture holds most of the moons, the large ones by more, and none is cut by its
    edge; of equal ones, where they stand evenly about the middle.
    """

    def worth(heading: float) -> float:
        total, balance = 0.0, 0.0
        for moon in moons:
            away = (moon.azimuth - heading + pi) % (2.0 * pi) - pi
            inside = half_width - abs(away)
            weight = 1.0 + 4.0 * moon.radius
            if inside >= moon.radius:
                total += weight
                balance += weight * away
            elif inside > -moon.radius:
                total -= 0.5 * weight
        return total - 0.2 * abs(balance) / max(half_width, 1e-6)

    return max((2.0 * pi * k / _HEADINGS - pi for k in range(_HEADINGS)), key=worth)


def flight(
    start: Floats, heading: float, length: float, height: float, ground: Floats, stops: int, width: float
) -> Floats:
    """(stops, 3) places on a straight line over the ground, points of shape (n, 3), at a height above the highest
    within `width` of each place; where there are none, at the height of the last. What is near is flown over in a
    smooth line: every place takes the mean of its neighbours' heights, if that is higher.
    """
    along = np.linspace(0.0, length, stops)
    places = np.column_stack(
        [start[0] - sin(heading) * along, start[1] + cos(heading) * along, np.full(stops, -np.inf)]
    )
    for k in range(stops):
        near = np.hypot(*(ground[:, :2] - places[k, :2]).T) <= width
        if near.any():
            places[k, 2] = float(ground[near, 2].max()) + height
    known = np.isfinite(places[:, 2])
    if not known.any():
        places[:, 2] = start[2]
        return places
    places[:, 2] = np.interp(along, along[known], places[known, 2])
    for _ in range(stops):
        middle = places[:, 2].copy()
        middle[1:-1] = 0.5 * (places[:-2, 2] + places[2:, 2])
        places[:, 2] = np.maximum(places[:, 2], middle)
    return places
