# SPDX-License-Identifier: GPL-3.0-or-later
"""Furnaces full of fog of albedo 1: every pixel is 1, whatever the optical depth."""

import numpy as np
import pytest

from addon.scene import description as d
from tests.render.build import BLACK, WHITE, Builder, camera, floor, grey, octahedron
from tests.render.statistics import INTEGRATORS, Measurement, Pictures, check_mean, check_radiance

pytestmark = pytest.mark.parametrize("integrator", INTEGRATORS)


def furnace(sigma_s: d.Rgb, g: float) -> Builder:
    """Inside a shining ball of radius 2."""
    view = camera((0.4, -1, 0.3), (0, 1, 0), 80)
    return Builder(view, medium=d.Medium(BLACK, sigma_s, g)).sphere((0, 0, 0), 2, d.Light(WHITE))


@pytest.mark.parametrize("g", [-0.7, 0, pytest.param(0.7, marks=pytest.mark.full)])
@pytest.mark.parametrize("sigma", [0.01, 0.3, 3])
def test_grey(integrator: str, sigma: float, g: float) -> None:
    # In thick isotropic fog a pass's light paths are few, and shared by all pixels.
    within = 0.08 if (integrator, sigma, g) == ("path", 3, 0) else 0.03
    check_radiance(Measurement(furnace(grey(sigma), g).done(), integrator), 1, within=within)


@pytest.mark.parametrize("g", [-0.7, 0, pytest.param(0.7, marks=pytest.mark.full)])
def test_coloured(integrator: str, g: float) -> None:
    """Channels that differ by a hundred share their paths."""
    check_radiance(Measurement(furnace((0.02, 0.2, 2), g).done(), integrator), 1, within=0.05)


@pytest.mark.parametrize("g", [0, 0.7])
def test_objects_within(integrator: str, g: float) -> None:
    scene = furnace(grey(0.5), g)
    scene.sphere((0, 0.5, 0), 0.5, d.Lambert(WHITE)).sphere((0.7, 0, 0.2), 0.3, d.Mirror(WHITE))
    scene.mesh(octahedron((-0.6, 0.2, 0), 0.4), d.Mix(0.5, d.Lambert(WHITE), d.Mirror(WHITE)))
    scene.sphere((0, 0, -0.6), 0.3, d.Glass(1.5))
    check_radiance(Measurement(scene.done(), integrator), 1, within=0.03)


def test_glass_around_the_camera(integrator: str) -> None:
    """Fog outside alone, and the same radiance in the glass."""
    scene = furnace(grey(0.5), 0).sphere((0.4, -1, 0.3), 0.2, d.Glass(1.5))
    # The camera stands at the glass sphere's centre: all rays leave it straight, or come back to it.
    check_radiance(Measurement(scene.done(), integrator), 1, within=0.03)


@pytest.mark.parametrize("height", [0.5, -0.5])
def test_sheet_of_glass(integrator: str, height: float) -> None:
    """Fog goes on behind it."""
    scene = furnace(grey(0.5), 0).mesh(floor(0, 3), d.Glass(1.5)).sphere((0, 0.5, 0.2), 0.5, d.Lambert(WHITE))
    scene.seen_by(camera((0.4, -1, height), (0, 1, 0), 80), d.Film(16, 16))
    check_radiance(Measurement(scene.done(), integrator), 1, within=0.03)


def test_every_pixel(integrator: str) -> None:
    """Not in the mean alone: 8 x 8 pixels, each by itself."""
    scene = furnace(grey(0.5), 0.3)
    scene.sphere((0, 0.5, 0), 0.5, d.Lambert(WHITE))
    pictures = Pictures(Measurement(scene.done(), integrator, samples=16))
    check_mean(lambda seed: pictures(seed).reshape(8, 2, 8, 2, 3).mean(axis=(1, 3, 4)), np.ones(64), within=0.1)


@pytest.mark.full
@pytest.mark.parametrize("tau", [30, 100])
def test_thick(integrator: str, tau: float) -> None:
    """A ceiling on the survival of Russian roulette would lose most of this."""
    check_radiance(Measurement(furnace(grey(tau / 2), 0).done(), integrator), 1, within=0.1)
