# SPDX-License-Identifier: GPL-3.0-or-later
"""Light that the fog scatters once, max_scatter 1: against quadrature of the volume rendering equation."""

import numpy as np
import pytest

from addon.scene import description as d
from tests.render import closed_forms as exact
from tests.render.build import BLACK, WHITE, Builder, grey, octahedron, quad, radiometer
from tests.render.statistics import INTEGRATORS, Measurement, check_radiance

pytestmark = pytest.mark.parametrize("integrator", INTEGRATORS)

ALONG = np.array([0.0, 1.0, 0.0])
SIGMA_A, SIGMA_S = 0.02, 0.08
SIGMA_T = SIGMA_A + SIGMA_S


def view(g: float, wall: float | None = None) -> Builder:
    """Along +y through fog; `wall`: the distance of a black wall that ends the ray."""
    scene = Builder(radiometer((0, 0, 0), ALONG), medium=d.Medium(grey(SIGMA_A), grey(SIGMA_S), g))
    if wall is not None:
        scene.mesh(quad((0, wall, 0), (3, 0, 0), (0, 0, 3)), d.Lambert(BLACK))
    return scene


def measured(scene: Builder, integrator: str) -> Measurement:
    return Measurement(scene.done(), integrator, samples=4, max_scatter=1)


@pytest.mark.parametrize("g", [0, 0.8, -0.6])
@pytest.mark.parametrize("wall", [None, 4])
@pytest.mark.parametrize(
    "light", [(1, 3, 0), (0.2, 2.5, 0.1), (2, -3, 1)], ids=["beside", "close to the ray", "behind"]
)
def test_point(integrator: str, light: tuple[float, float, float], wall: float | None, g: float) -> None:
    scene = view(g, wall).lamp(d.PointLight("point", light, WHITE))
    expected = exact.point_airlight(SIGMA_T, SIGMA_S, g, light, ALONG, wall or np.inf)
    check_radiance(measured(scene, integrator), expected, within=0.04)


@pytest.mark.parametrize("g", [0, 0.8, -0.6])
@pytest.mark.parametrize("wall", [None, 7])
def test_sphere(integrator: str, wall: float | None, g: float) -> None:
    """A moon beside the ray."""
    scene = view(g, wall).sphere((1.5, 5, 0.5), 1, d.Light(WHITE))
    expected = exact.sphere_airlight(SIGMA_T, SIGMA_S, g, 1, (1.5, 5, 0.5), ALONG, wall or np.inf)
    check_radiance(measured(scene, integrator), expected, within=0.02)


@pytest.mark.parametrize("g", [0, 0.8])
def test_sphere_on_the_ray(integrator: str, g: float) -> None:
    """The moon itself through fog that it lights."""
    scene = view(g).sphere((0, 6, 0), 1, d.Light(WHITE))
    airlight = exact.sphere_airlight(SIGMA_T, SIGMA_S, g, 1, (0, 6, 0), ALONG, 5)
    check_radiance(measured(scene, integrator), np.exp(-5 * SIGMA_T) + airlight, within=0.02)


def test_two_spheres_and_a_point(integrator: str) -> None:
    """One light at a time or all of them; their light adds up. The camera stands between."""
    scene = view(0.3)
    expected = 0.0
    for center, radius in (((2.0, 4.0, 1.0), 0.7), ((-1.0, -2.0, 2.0), 0.5)):
        scene.sphere(center, radius, d.Light(WHITE))
        expected += exact.sphere_airlight(SIGMA_T, SIGMA_S, 0.3, radius, center, ALONG, np.inf)
    scene.lamp(d.PointLight("point", (0.3, 9, -1), WHITE))
    expected += exact.point_airlight(SIGMA_T, SIGMA_S, 0.3, (0.3, 9, -1), ALONG, np.inf)
    check_radiance(measured(scene, integrator), expected, within=0.04)


def test_coloured_fog(integrator: str) -> None:
    """Each channel by its own coefficients."""
    sigma_a, sigma_s = (0.0, 0.05, 0.01), (0.3, 0.02, 0.1)
    scene = Builder(radiometer((0, 0, 0), ALONG), medium=d.Medium(sigma_a, sigma_s, 0.4))
    scene.sphere((1.5, 5, 0.5), 1, d.Light(WHITE))
    expected = [
        exact.sphere_airlight(a + s, s, 0.4, 1, (1.5, 5, 0.5), ALONG, np.inf)
        for a, s in zip(sigma_a, sigma_s, strict=True)
    ]
    check_radiance(measured(scene, integrator), expected, within=0.04)


def test_small_mesh_light(integrator: str) -> None:
    """A little body far off is a point whose intensity is radiance times the area of its outline from there."""
    size, center = 0.01, np.array([1.0, 3.0, 0.0])
    scene = view(0).mesh(octahedron(center, size), d.Light(grey(1 / size**2)))

    def source(t: float) -> float:
        to_light = center - t * ALONG
        distance = float(np.linalg.norm(to_light))
        w = np.abs(to_light) / distance
        # Cauchy: half the sum of |cosine| times area over the eight faces, each of area sqrt(3) / 2.
        intensity = sum(abs(w @ s) / np.sqrt(3) for s in SIGNS) * np.sqrt(3) / 4
        return float(SIGMA_S * np.exp(-SIGMA_T * (t + distance)) / (4 * np.pi) * intensity / distance**2)

    expected = exact.along_ray(source, 3, 1, np.inf)
    check_radiance(measured(scene, integrator), expected, within=0.04, rounding=size**2)


SIGNS = np.array([(x, y, z) for x in (1, -1) for y in (1, -1) for z in (1, -1)])


def test_fog_lights_a_plate(integrator: str) -> None:
    """From the lamp by way of the fog to a plate: its irradiance is an integral of airlight over the hemisphere."""
    light = np.array([0.0, 0, 3.0])
    medium = d.Medium(grey(SIGMA_A), grey(SIGMA_S))
    eye = 1e-3  # so near that no fog is between
    scene = Builder(radiometer((0, -eye, eye), (0, 0, 0)), medium=medium).mesh(
        quad((0, 0, 0), (1e-2, 0, 0), (0, 1e-2, 0)), d.Lambert(WHITE)
    )
    scene.lamp(d.PointLight("point", tuple(light), WHITE))
    theta, weight = exact.gauss(0, np.pi / 2, 40)
    fog = sum(
        w
        * 2
        * np.pi
        * np.sin(a)
        * np.cos(a)
        * exact.point_airlight(SIGMA_T, SIGMA_S, 0, light, np.array([np.sin(a), 0, np.cos(a)]), np.inf)
        for a, w in zip(theta, weight, strict=True)
    )
    direct = np.exp(-3 * SIGMA_T) / 9
    near = 2 * eye  # a bound on what the fog between eye and plate can do
    expected = (direct + fog) / np.pi
    check_radiance(
        Measurement(scene.done(), integrator, samples=4, max_scatter=1), expected, within=0.06, rounding=near
    )
