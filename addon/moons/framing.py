# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a group of moons goes so that a camera sees it: no Blender in here."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import asin, atan2, cos, hypot, sin, tan
from typing import Protocol, TypeVar

# The point that the five moons are composed for, and the share of a picture that they may fill.
EYE = (0.0, -4.0, 7.5)
SHARE = 0.85
HORIZON = 0.3  # of the picture's height, from below: where the horizon lies in a camera that is turned to them


class Placed(Protocol):
    @property
    def radius(self) -> float: ...
    @property
    def location(self) -> tuple[float, float, float]: ...


AnyMoon = TypeVar("AnyMoon", bound=Placed)


@dataclass(frozen=True)
class Eye:
    """A camera: its place, the angle of its look to the left of +y seen from above, and its half angles, in radians."""

    location: tuple[float, float, float]
    heading: float
    half_width: float
    half_height: float


def _angles(location: tuple[float, float, float]) -> tuple[float, float, float]:
    """Azimuth to the right of +y, elevation and distance, from EYE."""
    x, y, z = (a - b for a, b in zip(location, EYE, strict=True))
    return atan2(x, y), atan2(z, hypot(x, y)), hypot(x, y, z)


def frame(moons: Sequence[AnyMoon], eye: Eye) -> tuple[list[AnyMoon], float]:
    """The moons around an eye that looks along its heading, and the pitch to look with, up from level.

    All keep their distance; angles shrink alike where the picture is too small for them, and radii with them.
    """
    seen = [_angles(moon.location) for moon in moons]
    sizes = [asin(min(moon.radius / distance, 1.0)) for moon, (_, _, distance) in zip(moons, seen, strict=True)]
    across = max(abs(azimuth) + size for (azimuth, _, _), size in zip(seen, sizes, strict=True))
    above = max(elevation + size for (_, elevation, _), size in zip(seen, sizes, strict=True))
    shrink = min(1.0, SHARE * eye.half_width / across, SHARE * 2.0 * (1.0 - HORIZON) * eye.half_height / above)
    placed = []
    for moon, (azimuth, elevation, distance) in zip(moons, seen, strict=True):
        a, e = shrink * azimuth - eye.heading, shrink * elevation
        offset = (distance * cos(e) * sin(a), distance * cos(e) * cos(a), distance * sin(e))
        location = tuple(p + q for p, q in zip(eye.location, offset, strict=True))
        placed.append(replace(moon, location=location, radius=shrink * moon.radius))  # type: ignore[type-var]
    # The horizon stands at tan(-pitch) of the picture plane, whose lower edge is at -tan(half_height).
    return placed, atan2(tan(eye.half_height) * (1.0 - 2.0 * HORIZON), 1.0)
