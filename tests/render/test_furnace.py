# SPDX-License-Identifier: GPL-3.0-or-later
"""White furnaces: where everything that comes in is 1, what goes out is the albedo."""

import dataclasses

import numpy as np
import pytest

from addon.scene import description as d
from tests.render import closed_forms as exact
from tests.render.build import WHITE, Builder, box, camera, floor, grey, octahedron, quad, radiometer, sky
from tests.render.statistics import INTEGRATORS, Measurement, check_radiance

pytestmark = pytest.mark.parametrize("integrator", INTEGRATORS)

LAMBERT = d.Lambert((0.9, 0.5, 0.1))
CONVEX: dict[str, tuple[d.Surface, d.Rgb]] = {
    # material, albedo under uniform light
    "lambert": (LAMBERT, LAMBERT.albedo),
    "mirror": (d.Mirror((1, 0.6, 0.2)), (1, 0.6, 0.2)),
    "mix": (d.Mix(0.25, LAMBERT, d.Mirror(grey(0.8))), (0.825, 0.725, 0.625)),
    "emission": (d.Lambert((0.9, 0.5, 0.1), emission=(0.5, 2, 1)), (1.4, 2.5, 1.1)),
}
FAR = (7.0, -11.0, 5.0)


@pytest.mark.parametrize("shape", ["sphere", "mesh"])
@pytest.mark.parametrize("name", CONVEX)
def test_convex_body(integrator: str, name: str, shape: str) -> None:
    material, albedo = CONVEX[name]
    scene = Builder(camera(FAR, (0, 0, 0), 5), environment=sky())
    if shape == "sphere":
        scene.sphere((0, 0, 0), 2, material)
    else:
        scene.mesh(octahedron((0, 0, 0), 3), material)
    check_radiance(Measurement(scene.done(), integrator), albedo, within=0.01)


@pytest.mark.parametrize("mu", [1, 0.5, 0.1])
@pytest.mark.parametrize("alpha", [0.01, 0.1, 0.3, 1])
def test_rough_metal(integrator: str, alpha: float, mu: float) -> None:
    """Single scattering between microfacets alone: the directional albedo of the lobe."""
    view = radiometer((10 * np.sqrt(1 - mu**2), 0, 10 * mu), (0, 0, 0))
    scene = Builder(view, environment=sky()).mesh(floor(), d.Conductor(alpha, f0=WHITE))
    check_radiance(Measurement(scene.done(), integrator), exact.ggx_albedo(mu, alpha), within=0.01, rounding=2e-5)


@pytest.mark.parametrize("tilt", [-8, 4, 6])
def test_a_shading_normal_is_bent_until_it_reflects_above_the_surface(integrator: str, tilt: int) -> None:
    """Seen at 80 degrees from the true normal, the shading normal a further `tilt` degrees away: as far as the
    reflected cosine is .01 at least. Cycles 3.4 keeps 0.998, 0.884 and 0.712 too."""
    view, leaning = np.radians(80), np.radians(tilt)
    away = min(float(leaning), (np.arccos(0.01) - view) / 2)
    bent = view + away
    plate = dataclasses.replace(floor(), normals=np.tile([-np.sin(leaning), 0, np.cos(leaning)], (4, 1)))
    scene = Builder(radiometer((5 * np.sin(view), 0, 5 * np.cos(view)), (0, 0, 0)), environment=sky())
    scene.mesh(plate, d.Conductor(0.02, f0=WHITE))
    expected = exact.tilted_ggx_albedo(float(np.cos(bent)), 0.02, float(away))
    check_radiance(Measurement(scene.done(), integrator), expected, within=0.01, rounding=2e-5)


def test_rough_metal_sphere(integrator: str) -> None:
    """Analytic normals: seen at mu = 0.5."""
    target = np.array([0, 0, 2.0])
    view = radiometer(target + 6 * np.array([0, np.sqrt(0.75), 0.5]), target)
    scene = Builder(view, environment=sky()).sphere((0, 0, 0), 2, d.Conductor(0.3, f0=WHITE))
    check_radiance(Measurement(scene.done(), integrator), exact.ggx_albedo(0.5, 0.3), within=0.01)


@pytest.mark.parametrize("metal", [d.Conductor(1e-5, f0=WHITE), d.Conductor(0, f0=WHITE)], ids=["1e-5", "0"])
def test_all_but_smooth_metal_is_a_mirror(integrator: str, metal: d.Conductor) -> None:
    scene = Builder(radiometer((5, 0, 5), (0, 0, 0)), environment=sky()).mesh(floor(), metal)
    check_radiance(Measurement(scene.done(), integrator), 1, within=0)


@pytest.mark.parametrize("shape", ["sphere", "mesh", "nested", "air bubble"])
def test_glass(integrator: str, shape: str) -> None:
    """Through any glass a furnace is 1: what is refracted keeps its radiance, and what is not is reflected."""
    scene = Builder(camera(FAR, (0, 0, 0), 25), environment=sky())
    if shape == "mesh":
        scene.mesh(octahedron((0, 0, 0), 3), d.Glass(1.5))
    else:
        scene.sphere((0, 0, 0), 3, d.Glass(1.5))
    if shape == "nested":
        scene.sphere((0.5, 0, 0), 1.5, d.Glass(2.4)).sphere((0.5, 0, 0.5), 0.5, d.Lambert(WHITE))
    if shape == "air bubble":
        scene.sphere((0.5, 0, 0), 1.5, d.Glass(1))
    check_radiance(Measurement(scene.done(), integrator), 1, within=0.02)


@pytest.mark.parametrize("shape", ["sphere", "mesh", "nested"])
def test_camera_in_glass(integrator: str, shape: str) -> None:
    """Radiance there is 1 as well, of whatever index."""
    scene = Builder(camera((0.1, 0.2, 0.3), FAR, 100), environment=sky())
    if shape == "mesh":
        scene.mesh(octahedron((0, 0, 0), 3), d.Glass(1.5))
    else:
        scene.sphere((0, 0, 0), 3, d.Glass(1.5))
    if shape == "nested":
        scene.sphere((0, 0, 0), 1, d.Glass(1.2))
    # Off the centre: on it every ray would meet the sphere straight on.
    check_radiance(Measurement(scene.done(), integrator), 1, within=0.02)


@pytest.mark.parametrize("height", [3, -3])
def test_sheets_of_glass(integrator: str, height: float) -> None:
    """Before it and behind it, with a lit ball on either side."""
    scene = Builder(camera((0.1, -5, height), (0, 0, 0), 60), environment=sky())
    scene.mesh(floor(0, 30), d.Glass(1.5))
    scene.sphere((0, 1, 1.2), 1, d.Lambert(WHITE)).sphere((0, 1, -1.2), 1, d.Lambert(WHITE))
    check_radiance(Measurement(scene.done(), integrator), 1, within=0.02)


@pytest.mark.parametrize("shape", ["sphere", "mesh"])
@pytest.mark.parametrize(
    "material",
    [d.Lambert((0.5, 0.8, 0.9)), d.Mirror((0.5, 0.8, 0.9)), d.Mix(0.5, d.Lambert(grey(0.6)), d.Mirror((0.4, 1, 1)))],
    ids=["lambert", "mirror", "mix"],
)
def test_closed_furnace(integrator: str, material: d.Lambert | d.Mirror | d.Mix, shape: str) -> None:
    """Walls that emit e and reflect a, without end: e / (1 - a)."""
    albedo = (0.5, 0.8, 0.8) if isinstance(material, d.Mix) else (0.5, 0.8, 0.9)
    shining: d.Surface
    emission = (1.0, 0.5, 0.2)
    if isinstance(material, d.Lambert):
        shining = d.Lambert(material.albedo, emission)
    elif isinstance(material, d.Mirror):
        shining = d.Mirror(material.reflectance, emission)
    else:
        shining = d.Mix(material.weight, material.a, material.b, emission)
    scene = Builder(camera((0.2, 0.1, 0.3), (2, 1, 0), 80))
    if shape == "sphere":
        scene.sphere((0, 0, 0), 2, shining)
    else:
        scene.mesh(box((-2, -2, -1), (2, 2, 3)), shining)
    expected = [e / (1 - a) for e, a in zip(emission, albedo, strict=True)]
    check_radiance(Measurement(scene.done(), integrator), expected, within=0.03)


def test_no_light_is_lost_between_bodies(integrator: str) -> None:
    """White bodies close together, a groove and a white floor: many bounces, and 1 everywhere."""
    scene = Builder(camera((0, -9, 4), (0, 0, 0.5), 50), environment=sky())
    scene.mesh(floor(-1), d.Lambert(WHITE))
    scene.mesh(quad((-2, 0, 0), (0, 2, 0), (0.7, 0, 0.7)), d.Lambert(WHITE))
    scene.mesh(quad((2, 0, 0), (0, 2, 0), (-0.7, 0, 0.7)), d.Mix(0.5, d.Lambert(WHITE), d.Mirror(WHITE)))
    scene.sphere((0, 0, 0), 0.8, d.Lambert(WHITE)).sphere((0.3, 1.2, 0.2), 0.4, d.Mirror(WHITE))
    scene.sphere((-0.6, -1.3, -0.3), 0.6, d.Glass(1.5))
    check_radiance(Measurement(scene.done(), integrator), 1, within=0.02)
