# SPDX-License-Identifier: GPL-3.0-or-later
"""Presets of worlds and the views of cameras, in plain Python."""

import math
import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from addon.hexfield.parameters import FieldParameters
from addon.moons.kepler import MOST_ECCENTRIC
from addon.worlds.presets import PRESETS
from addon.worlds.views import Light, best_heading, flight


@pytest.mark.parametrize("key", list(PRESETS))
def test_presets_are_within_what_fields_and_orbits_allow(key: str) -> None:
    preset = PRESETS[key]
    FieldParameters(extent="RADIUS", radius=preset.reach(), planet_radius=preset.planet_radius, **preset.land)
    assert len({moon.name for moon in preset.moons}) == len(preset.moons)
    for moon in preset.moons:
        place = moon.place((0.0, 0.0, 5.0))
        assert np.linalg.norm(np.array(place) - (0.0, 0.0, 5.0)) == pytest.approx(moon.distance)
        assert moon.elevation - moon.angular_radius > -3.0 and abs(moon.azimuth) + moon.angular_radius < 29.0
        assert moon.eccentricity <= MOST_ECCENTRIC


def test_the_eclipse_is_one() -> None:
    """The black moon stands before the white one, nearer, and a ring of light is left."""
    white, black = PRESETS["BLACK_ECLIPSE"].moons[:2]
    assert (white.azimuth, white.elevation) == (black.azimuth, black.elevation)
    assert black.distance + black.radius() < white.distance - white.radius()
    assert 0.9 < black.angular_radius / white.angular_radius < 1.0


def test_the_best_heading_holds_most_moons_whole() -> None:
    moons = [Light(0.5, 0.2, 0.05), Light(0.7, 0.1, 0.1), Light(0.9, 0.2, 0.05), Light(-2.5, 0.3, 0.1)]
    heading = best_heading(moons, 0.5)
    assert abs(heading - 0.7) < 0.1
    around = best_heading([Light(3.1, 0.1, 0.02), Light(-3.1, 0.1, 0.02)], 0.4)
    assert abs(abs(around) - math.pi) < 0.1


def test_flights_stay_over_the_ground() -> None:
    x, y = np.meshgrid(np.arange(-10, 11), np.arange(-10, 111))
    ground = np.column_stack([x.ravel(), y.ravel(), 3 * np.sin(y.ravel() / 9)])
    places = flight(np.array([0.0, 0.0, 50.0]), 0.0, 100.0, 2.0, ground, 16, 6.0)
    np.testing.assert_allclose(places[:, 1], np.linspace(0, 100, 16))
    for place in places:
        near = np.hypot(*(ground[:, :2] - place[:2]).T) <= 6.0
        assert place[2] >= ground[near, 2].max() + 2.0 - 1e-9
    assert places[:, 2].max() <= 5.0 + 1e-9
    alone = flight(np.array([1.0, 2.0, 3.0]), math.pi / 2, 10.0, 2.0, np.empty((0, 3)), 4, 1.0)
    np.testing.assert_allclose(alone[-1], (-9.0, 2.0, 3.0), atol=1e-12)
