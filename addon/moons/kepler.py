# SPDX-License-Identifier: GPL-3.0-or-later
"""Kepler orbits: where a moon is at a frame, in closed form and as expressions of drivers. No Blender in here.

The expressions are of the kind that Blender evaluates by itself, without Python: files need no permission to run
scripts, and playback, renders and the background evaluate the same. Kepler's equation has no such expression, so the
eccentric anomaly is found in three steps, each a driven number: by iterating E = M + e sin E, then twice by Newton.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, cos, fmod, hypot, pi, sin, sqrt

MOST_ECCENTRIC = 0.9
_ITERATIONS = 18  # as many as fit into a driver's expression


@dataclass(frozen=True)
class Orbit:
    """Angles in radians, lengths in scene units, time in frames."""

    center: tuple[float, float, float] = (0.0, 0.0, 0.0)
    semi_axis: float = 10.0  # half of the long axis
    eccentricity: float = 0.0
    period: float = 250.0
    inclination: float = 0.0  # of the orbit's plane to the horizontal
    node: float = 0.0  # from the x axis to where the moon rises through the horizontal plane
    periapsis: float = 0.0  # from there to the point nearest to the centre
    phase: float = 0.0  # the mean anomaly at frame 0

    def mean_anomaly(self, frame: float) -> float:
        return 2.0 * pi * fmod(frame / self.period, 1.0) + self.phase

    def eccentric_anomaly(self, frame: float) -> float:
        """E of M = E - e sin E, by Newton's iteration to float64's last digits."""
        mean, e = self.mean_anomaly(frame), self.eccentricity
        anomaly = mean + e * sin(mean) / (1.0 - sin(mean + e) + sin(mean)) if e < 0.5 else mean
        low, high = mean - e, mean + e
        anomaly = min(max(anomaly, low), high)
        for _ in range(60):
            rest = anomaly - e * sin(anomaly) - mean
            if rest > 0.0:
                high = anomaly
            else:
                low = anomaly
            following = anomaly - rest / (1.0 - e * cos(anomaly))
            if not low <= following <= high:
                following = 0.5 * (low + high)
            if following == anomaly:
                break
            anomaly = following
        return anomaly

    def place(self, frame: float) -> tuple[float, float, float]:
        anomaly = self.eccentric_anomaly(frame)
        along = self.semi_axis * (cos(anomaly) - self.eccentricity)
        across = self.semi_axis * sqrt(1.0 - self.eccentricity**2) * sin(anomaly)
        cn, sn, cp, sp = cos(self.node), sin(self.node), cos(self.periapsis), sin(self.periapsis)
        ci, si = cos(self.inclination), sin(self.inclination)
        nearest = (cn * cp - sn * sp * ci, sn * cp + cn * sp * ci, sp * si)
        ahead = (-cn * sp - sn * cp * ci, -sn * sp + cn * cp * ci, cp * si)
        x, y, z = (c + along * p + across * q for c, p, q in zip(self.center, nearest, ahead, strict=True))
        return x, y, z


def through(
    place: tuple[float, float, float],
    frame: float,
    period: float,
    center: tuple[float, float, float] = (0.0, 0.0, 0.0),
    eccentricity: float = 0.0,
    is_eastward: bool = False,
) -> Orbit:
    """The orbit on which a moon stands highest and nearest at that place and frame. Seen from the centre it goes
    left, or right where is_eastward.
    """
    x, y, z = (a - b for a, b in zip(place, center, strict=True))
    azimuth, elevation = atan2(y, x), atan2(z, hypot(x, y))
    return Orbit(
        center=center,
        semi_axis=hypot(x, y, z) / (1.0 - eccentricity),
        eccentricity=eccentricity,
        period=period,
        inclination=pi - elevation if is_eastward else elevation,
        node=azimuth + 0.5 * pi if is_eastward else azimuth - 0.5 * pi,
        periapsis=0.5 * pi,
        phase=-2.0 * pi * fmod(frame / period, 1.0),
    )


# The variables of the expressions: a letter each, since there is room for 255 characters. Those of an orbit, and those
# that the drivers give each other.
VARIABLES = {
    "a": "semi_axis",
    "e": "eccentricity",
    "t": "period",
    "i": "inclination",
    "n": "node",
    "w": "periapsis",
    "p": "phase",
    "x": "center_x",
    "y": "center_y",
    "z": "center_z",
}
STEPS = {"m": "mean_anomaly", "f": "first_approximation", "g": "second_approximation", "h": "eccentric_anomaly"}
MEAN = "2*pi*fmod(frame/t,1)+p"
_NEWTON = "{0}-({0}-e*sin({0})-m)/(1-e*cos({0}))"
# Each of the anomalies is a step from the one before.
ANOMALIES = (
    MEAN,
    "m" + "+e*sin(m" * _ITERATIONS + ")" * _ITERATIONS,
    _NEWTON.format("f"),
    _NEWTON.format("g"),
)
_ALONG, _ACROSS = "(cos(h)-e)", "sqrt(1-e*e)*sin(h)"
PLACE = (
    f"x+a*({_ALONG}*(cos(n)*cos(w)-sin(n)*sin(w)*cos(i))-{_ACROSS}*(cos(n)*sin(w)+sin(n)*cos(w)*cos(i)))",
    f"y+a*({_ALONG}*(sin(n)*cos(w)+cos(n)*sin(w)*cos(i))+{_ACROSS}*(cos(n)*cos(w)*cos(i)-sin(n)*sin(w)))",
    f"z+a*({_ALONG}*sin(w)+{_ACROSS}*cos(w))*sin(i)",
)
