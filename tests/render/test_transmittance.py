# SPDX-License-Identifier: GPL-3.0-or-later
"""Beer and Lambert: a light seen through fog, and one shadow ray through it."""

import numpy as np
import pytest

from addon.scene import description as d
from tests.render.build import BLACK, WHITE, Builder, camera, floor, grey, radiometer, sky
from tests.render.statistics import INTEGRATORS, ROUNDING, Measurement, Pictures, check_radiance

pytestmark = pytest.mark.parametrize("integrator", INTEGRATORS)

DISTANCE = 10.0


def depth_rounding(depth: float) -> float:
    """An optical depth that is off by 2^-23 of itself, twice (sigma and distance), moves its exponential by that."""
    return ROUNDING + 2 * depth * 2.0**-23


def light_through(medium: d.Medium) -> Builder:
    """A ball that shines (1, 2, 3), its surface at DISTANCE."""
    view = radiometer((0, 0, 0), (0, 1, 0))
    return Builder(view, medium=medium).sphere((0, DISTANCE + 2, 0), 2, d.Light((1, 2, 3)))


@pytest.mark.parametrize("depth", [1e-4, 1e-2, 1, 10, 50, 85])
def test_absorption(integrator: str, depth: float) -> None:
    scene = light_through(d.Medium(grey(depth / DISTANCE), BLACK))
    expected = np.exp(-depth) * np.array([1, 2, 3])
    check_radiance(Measurement(scene.done(), integrator), expected, within=0, rounding=depth_rounding(depth))


def test_channels(integrator: str) -> None:
    depth = np.array([0.01, 1, 12])
    scene = light_through(d.Medium(tuple(depth / DISTANCE), BLACK))
    expected = np.exp(-depth) * [1, 2, 3]
    check_radiance(Measurement(scene.done(), integrator), expected, within=0, rounding=depth_rounding(12))


@pytest.mark.parametrize("depth", [1e-3, 1, 10])
def test_what_is_scattered_out(integrator: str, depth: float) -> None:
    """With max_scatter 0 nothing is scattered in."""
    scene = light_through(d.Medium(BLACK, (depth / DISTANCE, 0, 2 * depth / DISTANCE), 0.5))
    expected = np.exp([-depth, 0, -2 * depth]) * [1, 2, 3]
    check_radiance(
        Measurement(scene.done(), integrator, max_scatter=0), expected, within=0, rounding=depth_rounding(2 * depth)
    )


def test_max_depth_0_is_emission_alone(integrator: str) -> None:
    scene = light_through(d.Medium(grey(0.02), grey(0.05))).lamp(d.PointLight("point", (0, 5, 3), WHITE))
    expected = np.exp(-0.7) * np.array([1, 2, 3])
    check_radiance(Measurement(scene.done(), integrator, max_depth=0), expected, within=0, rounding=depth_rounding(0.7))


def test_shadow_rays(integrator: str) -> None:
    """Both ways: to the plate from the light, to the camera from the plate; channels differ."""
    sigma = np.array([0.05, 0.2, 0])
    eye = np.array([0, -3.0, 4])
    scene = Builder(radiometer(eye, (0, 0, 0)), medium=d.Medium(tuple(sigma), BLACK))
    scene.mesh(floor(), d.Lambert(grey(0.5))).lamp(d.PointLight("point", (2, 0, 6), WHITE))
    way = np.sqrt(40)
    expected = 0.5 / np.pi * 6 / way**3 * np.exp(-sigma * (way + 5))
    check_radiance(Measurement(scene.done(), integrator), expected, within=1e-4, rounding=depth_rounding(3))


def test_glass_holds_no_fog(integrator: str) -> None:
    """A ball of index 1 on the way: the fog inside it is not there."""
    scene = light_through(d.Medium(grey(0.1), BLACK)).sphere((0, 5, 0), 3, d.Glass(1))
    expected = np.exp(-0.4) * np.array([1, 2, 3])
    check_radiance(Measurement(scene.done(), integrator), expected, within=0, rounding=depth_rounding(1))


def test_endless_fog_is_opaque(integrator: str) -> None:
    """Environment and sun behind it are exactly black; without scattering so is the picture."""
    scene = Builder(radiometer((0, 0, 5), (0, 0, 0)), medium=d.Medium(grey(1e-3), BLACK), environment=sky())
    scene.lamp(d.SunLight("sun", (0, 0, -1), WHITE, 0.5)).mesh(floor(), d.Lambert(WHITE))
    check_radiance(Measurement(scene.done(), integrator, samples=8), 0, within=0)


def test_glints_at_the_end_of_sight(integrator: str) -> None:
    """Ground at optical depths of 80 to 110, where floats lose their digits, beside metal that is near: no fault."""
    scene = Builder(camera((0, -7, 1.7), (0, 0, 1.5), 50), 24, 18, medium=d.Medium(grey(0.015), grey(0.485), 0.3))
    scene.mesh(floor(0, 200), d.Lambert(grey(0.4))).sphere((1, 1, 0.7), 0.7, d.Conductor(0.2, f0=grey(0.9)))
    pictures = Pictures(Measurement(scene.lamp(d.PointLight("point", (0, 3, 4), WHITE)).done(), integrator, samples=4))
    for seed in range(4):  # it counts samples that are no numbers
        assert pictures(seed).mean() > 0
