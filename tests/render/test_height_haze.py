# SPDX-License-Identifier: GPL-3.0-or-later
"""Haze that thins out exponentially with height: the closed forms, and what they say of a sun and of lamps."""

from typing import Any

import numpy as np
import pytest

from addon.scene import description as d
from tests.render import closed_forms as exact
from tests.render.build import BLACK, WHITE, Builder, camera, floor, grey, radiometer, sky, unit
from tests.render.statistics import INTEGRATORS, Measurement, check_radiance

pytestmark = pytest.mark.parametrize("integrator", INTEGRATORS)

HEIGHT, SCALE = 1.0, 2.0  # sigma is what it says at this height, and thins out by e every 2


def haze(sigma_a: Any, sigma_s: Any, g: float = 0) -> d.Medium:
    return d.Medium(sigma_a, sigma_s, g, falloff=d.Falloff(HEIGHT, SCALE))


def depth(sigma: Any, start: float, slope: float, length: Any) -> Any:
    """Of a ray that starts at a height and rises by a slope."""
    b = slope / SCALE
    return sigma * np.exp((HEIGHT - start) / SCALE) * (length if b == 0 else -np.expm1(-b * length) / b)


@pytest.mark.parametrize(
    ("slope", "start"), [(-0.9, 0.0), (-1e-4, -20.0), (0.0, 30.0), (1e-5, 30.0), (0.3, -20.0), (1.0, 0.0)]
)
def test_transmittance(integrator: str, slope: float, start: float) -> None:
    """To a wall of light 5 away."""
    sigma = np.array([0.02, 0.1, 0.4]) * np.exp((start - HEIGHT) / SCALE)
    direction = np.array([0.0, np.sqrt(1 - slope**2), slope])
    scene = Builder(radiometer((0, 0, start), np.array([0, 0, start]) + direction), medium=haze(tuple(sigma), BLACK))
    scene.sphere(np.array([0, 0, start]) + 7 * direction, 2, d.Light(WHITE))
    expected = np.exp(-depth(sigma, start, slope, 5))
    check_radiance(Measurement(scene.done(), integrator), expected, within=1e-4, rounding=2e-5)


def test_the_sky_is_seen(integrator: str) -> None:
    """Upwards through all of it; downwards nothing is left."""
    for slope, expected in ((0.5, np.exp(-depth(0.3, 0, 0.5, np.inf))), (-0.1, 0.0)):
        direction = np.array([0.0, np.sqrt(1 - slope**2), slope])
        scene = Builder(radiometer((0, 0, 0), direction), medium=haze(grey(0.3), BLACK), environment=sky())
        check_radiance(Measurement(scene.done(), integrator), expected, within=1e-4, rounding=2e-5)


@pytest.mark.parametrize(("slope", "angle"), [(-0.6, 0), (0.0, 4), (0.4, 0)])
def test_sun(integrator: str, angle: float, slope: float) -> None:
    """One scattering of a low sun's light, before a black wall and before nothing."""
    sigma_a, sigma_s, g = 0.05, 0.2, 0.5
    direction, from_sun = np.array([0.0, np.sqrt(1 - slope**2), slope]), unit(np.array([1.0, -0.4, -0.6]))
    scene = Builder(radiometer((0, 0, 0), direction), medium=haze(grey(sigma_a), grey(sigma_s), g))
    scene.lamp(d.SunLight("sun", tuple(from_sun), WHITE, angle))
    end = 12.0
    if slope != 0.4:
        scene.sphere((end + 2) * direction, 2, d.Lambert(BLACK)).hide(d.EVERY_RAY & ~d.Rays.SHADOW)
    else:
        end = 80.0
    t, w = exact.gauss(0, end, 400)
    rise = -from_sun[2]
    z = slope * t
    to_sun = (sigma_a + sigma_s) * np.exp((HEIGHT - z) / SCALE) * SCALE / rise
    source = sigma_s * np.exp((HEIGHT - z) / SCALE) * np.exp(-depth(sigma_a + sigma_s, 0, slope, t) - to_sun)
    expected = float(exact.henyey_greenstein(g, -(direction @ from_sun))) * np.sum(w * source)
    # A wide sun is brighter where it is higher, by less than this.
    check_radiance(Measurement(scene.done(), integrator, samples=16, max_scatter=1), expected, within=0.04)


def test_lamp(integrator: str) -> None:
    sigma_s, g = 0.2, -0.3
    scene = Builder(radiometer((0, 0, 0), (0.6, 0.8, 0)), medium=haze(BLACK, grey(sigma_s), g))
    at = np.array([3.0, 3.0, 1.0])
    scene.lamp(d.PointLight("lamp", tuple(at), WHITE))
    direction = np.array([0.6, 0.8, 0.0])
    t, w = exact.gauss(0, 40, 2000)
    way = t[:, None] * direction - at
    length = np.linalg.norm(way, axis=1)
    across = np.array([depth(sigma_s, 1.0, v[2] / n, n) for v, n in zip(way, length, strict=True)])
    scattering = sigma_s * np.exp(HEIGHT / SCALE)
    phase = exact.henyey_greenstein(g, -(way @ direction) / length)
    expected = np.sum(w * scattering * phase * np.exp(-scattering * t - across) / length**2)
    check_radiance(Measurement(scene.done(), integrator, samples=16, max_scatter=1), expected, within=0.04)


def test_white_haze_over_a_white_ground_cannot_be_seen(integrator: str) -> None:
    scene = Builder(camera((0, -3, 1), (0, 0, 0.5), 60), medium=haze(BLACK, (0.1, 0.2, 0.15), 0.3), environment=sky())
    scene.mesh(floor(0, 400), d.Lambert(WHITE)).sphere((0, 1, 0.6), 0.5, d.Glass(1.4))
    check_radiance(Measurement(scene.done(), integrator, samples=4), 1, within=0.03)
