# SPDX-License-Identifier: GPL-3.0-or-later
"""Lamp units by integrating what a lamp sends out: the power that Blender shows must come out of it."""

from math import pi

import pytest

from addon.export.light import area_radiance, ellipse_or_rectangle_area, point_intensity


def test_a_point_sends_its_power_over_the_whole_sphere() -> None:
    assert point_intensity(100.0) * 4.0 * pi == pytest.approx(100.0)


@pytest.mark.parametrize(("size", "ellipse"), [((2.0, 3.0), False), ((2.0, 3.0), True)])
def test_an_area_lamp_sends_its_power_from_its_front(size: tuple[float, float], ellipse: bool) -> None:
    area = ellipse_or_rectangle_area(size, ellipse)
    # A Lambertian emitter of radiance L sends pi L A.
    assert area_radiance(100.0, area, (4, 2, 0)) * pi * area == pytest.approx(100.0)


def test_an_area_lamp_of_old_versions_is_brighter_by_a_quarter_of_pi() -> None:
    assert area_radiance(1.0, 1.0, (3, 4, 1)) / area_radiance(1.0, 1.0, (5, 0, 1)) == pytest.approx(pi / 4.0)


def test_an_ellipse_fills_pi_quarters_of_its_rectangle() -> None:
    assert ellipse_or_rectangle_area((2.0, 3.0), True) == pytest.approx(pi * 1.0 * 1.5)
