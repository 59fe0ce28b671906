# SPDX-License-Identifier: GPL-3.0-or-later
"""Kepler orbits and the expressions of their drivers, in plain Python."""

import math
import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from addon.moons import kepler
from addon.moons.kepler import MOST_ECCENTRIC, Orbit, through

FRAMES = range(-50, 120, 3)
ECCENTRICITIES = (0.0, 0.3, 0.6, MOST_ECCENTRIC)


def orbit(eccentricity: float) -> Orbit:
    return Orbit((1.0, 2.0, 3.0), 7.0, eccentricity, 33.0, 0.4, 0.3, 1.1, 0.7)


@pytest.mark.parametrize("eccentricity", ECCENTRICITIES)
def test_the_anomaly_solves_keplers_equation(eccentricity: float) -> None:
    path = orbit(eccentricity)
    for frame in FRAMES:
        anomaly = path.eccentric_anomaly(frame)
        assert anomaly - eccentricity * math.sin(anomaly) == pytest.approx(path.mean_anomaly(frame), abs=1e-13)


@pytest.mark.parametrize("eccentricity", ECCENTRICITIES)
def test_moons_keep_keplers_laws(eccentricity: float) -> None:
    """An ellipse with the centre in a focus, equal areas in equal times, and once around in a period."""
    path = orbit(eccentricity)
    places = np.array([path.place(frame) for frame in np.linspace(0, 33, 4001)]) - path.center
    np.testing.assert_allclose(places[0], places[-1], atol=1e-9)
    distance = np.linalg.norm(places, axis=1)
    # Nearest where the mean anomaly is 0, and farthest half a period later.
    nearest_at = -path.phase / (2 * math.pi) * 33
    near, far = (np.array(path.place(frame)) - path.center for frame in (nearest_at, nearest_at + 16.5))
    assert np.linalg.norm(near) == pytest.approx(7 * (1 - eccentricity), rel=1e-12)
    assert np.linalg.norm(far) == pytest.approx(7 * (1 + eccentricity), rel=1e-12)
    assert distance.min() >= np.linalg.norm(near) - 1e-9 and distance.max() <= np.linalg.norm(far) + 1e-9
    normal = (math.sin(0.3) * math.sin(0.4), -math.cos(0.3) * math.sin(0.4), math.cos(0.4))
    assert np.abs(places @ normal).max() < 1e-12
    # The other focus: the sum of the distances is the long axis.
    other = -2 * 7 * eccentricity * near / np.linalg.norm(near)
    np.testing.assert_allclose(distance + np.linalg.norm(places - other, axis=1), 14.0, rtol=1e-12)
    areas = 0.5 * np.cross(places[:-1], places[1:]) @ normal
    np.testing.assert_allclose(areas, math.pi * 49 * math.sqrt(1 - eccentricity**2) / 4000, rtol=0.01)


@pytest.mark.parametrize("eccentricity", ECCENTRICITIES)
def test_the_drivers_expressions_are_the_orbit(eccentricity: float) -> None:
    """Evaluated as Blender does it, step by step; each fits into the 255 characters that a driver has."""
    path = orbit(eccentricity)
    values: dict[str, float] = {"a": 7.0, "e": eccentricity, "t": 33.0, "i": 0.4, "n": 0.3, "w": 1.1, "p": 0.7}
    values |= {"x": 1.0, "y": 2.0, "z": 3.0}
    functions = {name: getattr(math, name) for name in ("sin", "cos", "sqrt", "fmod", "pi")}
    for frame in FRAMES:
        values["frame"] = frame
        for letter, expression in zip(kepler.STEPS, kepler.ANOMALIES, strict=True):
            assert len(expression) < 256
            values[letter] = eval(expression, functions, values)
        found = [eval(expression, functions, values) for expression in kepler.PLACE]
        np.testing.assert_allclose(found, path.place(frame), atol=1e-9)
    assert max(map(len, kepler.PLACE)) < 256


@pytest.mark.parametrize("is_eastward", [False, True])
def test_an_orbit_through_a_place_is_highest_there(is_eastward: bool) -> None:
    place, center = (3.0, 8.0, 5.0), (0.0, 1.0, 1.0)
    path = through(place, 17.0, 90.0, center, 0.4, is_eastward)
    np.testing.assert_allclose(path.place(17.0), place, atol=1e-12)
    around = np.array([path.place(frame) for frame in np.linspace(0, 90, 181)])
    assert around[:, 2].max() <= 5.0 + 1e-9
    step = np.array(path.place(17.1)) - place
    right = step @ np.array([7.0, -3.0, 0.0])  # as seen from the centre
    assert (right > 0) == is_eastward
