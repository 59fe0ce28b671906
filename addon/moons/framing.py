# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a camera stands over the ground and where a group of moons goes so that it sees both: no Blender in here."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import asin, atan2, cos, hypot, sin, tan
from typing import Any, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

# The point that the five moons are composed for, and the share of a picture that they may fill.
EYE = (0.0, -4.0, 7.5)
SHARE = 0.85
HORIZON = 0.4  # of the picture's height, from below: where the horizon lies in a camera that is turned to them
EYE_HEIGHT = 2.5  # above the ground, in scene units
NEAR = 0.4  # of the way to the far end of the ground: no further may the picture's lower edge meet it
LEAST = 0.3  # of its height over the ground ahead: so much a camera keeps above the ground around it


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


def look_pitch(eye: Eye) -> float:
    """Up from level, so that the horizon lies at HORIZON."""
    # The horizon stands at tan(-pitch) of the picture plane, whose lower edge is at -tan(half_height).
    return atan2(tan(eye.half_height) * (1.0 - 2.0 * HORIZON), 1.0)


def stand(eye: Eye, ground: NDArray[Any], floor: float) -> Eye:
    """The same camera at a height from which, looking with look_pitch, it sees the ground: points of shape (n, 3).

    It stays where it is low already, but above the ground. Where no point lies ahead, the ground is a plane without end
    at `floor`, and a camera below it stays there.
    """
    x, y, z = eye.location
    offset = ground - eye.location
    forward = offset[:, :2] @ (-sin(eye.heading), cos(eye.heading))
    across = offset[:, :2] @ (cos(eye.heading), sin(eye.heading))
    ahead = np.abs(across) < forward * tan(eye.half_width)
    if not ahead.any():
        return replace(eye, location=(x, y, min(z, floor + EYE_HEIGHT) if z > floor else z))
    level = float(np.median(ground[ahead, 2]))
    height = min(EYE_HEIGHT, NEAR * float(forward[ahead].max()) * tan(eye.half_height - look_pitch(eye)))
    around = ground[np.hypot(offset[:, 0], offset[:, 1]) < 2.0 * height, 2]
    lowest = max(level, float(around.max(initial=level))) + LEAST * height
    wanted = max(lowest, level + height)
    return replace(eye, location=(x, y, z if lowest <= z <= wanted else wanted))


def frame(moons: Sequence[AnyMoon], eye: Eye) -> list[AnyMoon]:
    """The moons around an eye that looks along its heading with look_pitch.

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
    return placed
