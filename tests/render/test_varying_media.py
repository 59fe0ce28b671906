# SPDX-License-Identifier: GPL-3.0-or-later
"""Media whose coefficients shader programs give: transmittance, scattering, emission and energy."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from addon.scene import description as d
from addon.scene.program import Op, programmed
from tests.engine.library import Render, Scene
from tests.render import closed_forms as exact
from tests.render.build import BLACK, WHITE, Builder, box, camera, grey, octahedron, radiometer, sky
from tests.render.statistics import Measurement, check_radiance

pytestmark = pytest.mark.parametrize("integrator", ["path"])  # the baseline does the same

ALONG = np.array([0.0, 1.0, 0.0])


def math(kind: str, a: Op | float, b: Op | float = 0.0, c: Op | float = 0.0) -> Op:
    return Op("math", (a, b, c), (kind, "free"))


def place(axis: str, space: str = "position") -> Op:
    return Op("separate", (Op("geometry", (1.0,), (space, "center")),), (axis,))


def vector(*channels: Op | float) -> Op:
    return Op("combine", channels if len(channels) == 3 else channels * 3)


def medium(**coefficients: Any) -> d.Medium:
    found, program = programmed(d.Medium(**{"sigma_a": BLACK, "sigma_s": BLACK, **coefficients}))
    assert isinstance(found, d.Medium)
    return replace(found, program=program)


def along_y(start: float = 0.0, **parts: Any) -> Builder:
    """Along +y, beside all edges of boxes about the axis."""
    return Builder(radiometer((0.03, start, 0.07), (0.03, start + 1, 0.07)), **parts)


def slab(near: float, far: float) -> d.Mesh:
    return box((-1, near, -1.3), (1.1, far, 1))


def noise(scale: float, detail: float = 2.0) -> Op:
    """0 to 1."""
    at = Op("geometry", (1.0,), ("object_position", "center"))
    return Op("noise", (at, 0.0, detail, 0.5, 2.0, 0.0, 1.0, 0.0), ("3d", "fbm", "normalized", "from_4"))


# Density along y, from 3 to 5, and its integral.
DENSITIES: dict[str, tuple[Callable[[Op], Op], float]] = {
    "linear": (lambda s: s, 2.0),
    "exponential": (lambda s: math("exponent", math("multiply", s, -1.5)), (1 - np.exp(-3)) / 1.5),
    "steps": (lambda s: math("floor", math("multiply", s, 2.0)), (0 + 1 + 2 + 3) / 2),
}


# ---- Transmittance -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", DENSITIES)
@pytest.mark.parametrize("depth", [1e-3, 1])
def test_slab(integrator: str, kind: str, depth: float) -> None:
    """Between 3 and 5, before a white sky."""
    density, total = DENSITIES[kind]
    sigma = math("multiply", density(math("subtract", place("y"), 3.0)), depth / total)
    scene = along_y(environment=sky()).mesh(slab(3, 5), d.Null(), interior=medium(sigma_a=vector(sigma)))
    expected = np.exp(-depth)
    check_radiance(Measurement(scene.done(), integrator, samples=16), expected, within=0.05)


def test_nothing_comes_through(integrator: str) -> None:
    sigma = math("multiply", math("subtract", place("y"), 3.0), 500.0)
    scene = along_y(environment=sky()).mesh(slab(3, 5), d.Null(), interior=medium(sigma_a=vector(sigma)))
    check_radiance(Measurement(scene.done(), integrator, samples=16), 0, within=1e-6)


def test_media_add_up(integrator: str) -> None:
    """Two that vary, by channel and unlike, over one that does not and one everywhere, before a lamp."""
    y = place("y")
    first = medium(sigma_a=vector(math("multiply", y, 0.02), math("multiply", y, 0.05), 0.0))
    second = medium(sigma_a=vector(0.1, 0.0, math("divide", 1.0, y)))
    scene = along_y(medium=d.Medium(grey(0.05), BLACK)).sphere((0, 12, 0), 2, d.Light(WHITE))
    scene.mesh(slab(1, 4), d.Null(), interior=first)
    scene.mesh(slab(3, 6), d.Null(), interior=second)
    scene.mesh(slab(2, 5), d.Null(), interior=d.Medium(grey(0.1), BLACK))
    reach = 12 - np.sqrt(4 - 0.03**2 - 0.07**2)
    depth = 0.05 * reach + 0.1 * 3 + np.array([0.02 * 7.5 + 0.1 * 3, 0.05 * 7.5, np.log(2)])
    check_radiance(Measurement(scene.done(), integrator, samples=16), np.exp(-depth), within=0.05)


def test_bodies_carry_their_media_along(integrator: str) -> None:
    """Instances that are scaled and mirrored, density by the object's own coordinates."""
    interior = medium(sigma_a=vector(math("multiply", place("y", "object_position"), 0.1)))
    places = np.stack([np.eye(4), np.diag([1.0, 3, 1, 1]), np.diag([-1.0, 1, 1, 1])])
    places[1, 1, 3], places[2, 1, 3] = -1.0, 8.0
    scene = along_y(environment=sky()).mesh(slab(1, 2), d.Null(), instances=places, interior=interior)
    depth = 0.15 + 3 * 0.15 + 0.15
    check_radiance(Measurement(scene.done(), integrator, samples=16), np.exp(-depth), within=0.01)


def test_instances_have_numbers_of_their_own(integrator: str) -> None:
    """Density by an attribute of the instances."""
    interior = medium(sigma_a=Op("attribute", (1.0,), ("center",), "density"))
    places = np.stack([np.eye(4), np.eye(4)])
    places[1, 1, 3] = 2.0
    scene = along_y(environment=sky()).mesh(slab(1, 2), d.Null(), instances=places, interior=interior).done()
    rows = np.array([[0.3, 0.1, 0.0], [0.4, 0.0, 0.2]], np.float32)
    objects = (replace(scene.objects[0], attributes=(d.Attribute("density", "instance", rows),)),)
    expected = np.exp(-rows.sum(axis=0))
    check_radiance(Measurement(replace(scene, objects=objects), integrator, samples=16), expected, within=0.01)


def test_what_majorants_miss(integrator: str) -> None:
    """A sheet far thinner than samples of the density are apart; the report counts what was denser than expected."""
    inside = math("multiply", math("greater_than", place("y"), 4.0501), math("less_than", place("y"), 4.0531))
    sigma = math("add", 0.2, math("multiply", inside, 4.0))
    scene = along_y(environment=sky()).mesh(slab(3, 5), d.Null(), interior=medium(sigma_a=vector(sigma)))
    expected = np.exp(-0.4 - 0.003 * 4)
    check_radiance(Measurement(scene.done(), integrator, samples=64), expected, within=0.01)
    with Render(Scene(scene.done()), integrator=integrator, samples=64, threads=1) as render:
        render.run()
        assert render.report()["majorants_exceeded"] > 0


# ---- Emission ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("sigma", [0.0, 0.4])
def test_emission(integrator: str, sigma: float) -> None:
    """That grows along the ray."""
    s = math("subtract", place("y"), 3.0)
    shining = medium(sigma_a=grey(sigma), emission=vector(s, math("multiply", s, 2.0), 0.0))
    scene = along_y(environment=sky(0.5)).mesh(slab(3, 5), d.Null(), interior=shining)
    length = (1 - np.exp(-2 * sigma) * (1 + 2 * sigma)) / sigma**2 if sigma else 2
    expected = 0.5 * np.exp(-2 * sigma) + length * np.array([1, 2, 0])
    check_radiance(Measurement(scene.done(), integrator, samples=16), expected, within=0.05)


# ---- Scattering ----------------------------------------------------------------------------------------------------


def test_sun_from_outside(integrator: str) -> None:
    """Light that comes down into a box whose density grows along the view, and is scattered once."""
    density = math("multiply", place("y"), 0.1)
    scattering = medium(
        sigma_a=vector(math("multiply", density, 0.25)),
        sigma_s=vector(math("multiply", density, 0.75)),
        g=math("multiply", place("y"), 0.1),
    )
    scene = along_y().lamp(d.SunLight("sun", (0, 0, -1), WHITE, 0))
    scene.mesh(box((-3, 0, -3), (3, 5, 3)), d.Null(), interior=scattering)
    t, w = exact.gauss(0, 5, 64)
    phase = np.array([float(exact.henyey_greenstein(0.1 * ti, 0.0)) for ti in t])
    expected = np.sum(w * 0.075 * t * phase * np.exp(-0.05 * t**2 - 0.1 * t * 2.93))
    check_radiance(Measurement(scene.done(), integrator, samples=16, max_scatter=1), expected, within=0.04)


def test_lamp_inside(integrator: str) -> None:
    """Beside a medium that does not vary, and one that does; a lamp with a size, which paths may meet."""
    sigma = math("multiply", place("y"), 0.04)
    scene = Builder(radiometer((0, 0, 0), ALONG)).lamp(d.PointLight("lamp", (1, 3, 0), WHITE, 0.02))
    scene.mesh(box((-3, -1, -3), (3, 5, 3)), d.Null(), interior=medium(sigma_s=vector(sigma)))
    scene.mesh(box((-3, -1, -3), (3, 5, 3)), d.Null(), interior=d.Medium(grey(0.02), grey(0.03)))
    t, w = exact.gauss(0, 5, 400)
    way = np.hypot(1, t - 3)
    depth = 0.05 * (t + way) + 0.02 * t**2 + 0.04 * way * (t + 3) / 2
    expected = np.sum(w * (0.03 + 0.04 * t) / (4 * np.pi) * np.exp(-depth) / way**2)
    check_radiance(Measurement(scene.done(), integrator, samples=16, max_scatter=1), expected, within=0.04)


# ---- Energy --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("depth", [1e-3, 1, pytest.param(10, marks=pytest.mark.full)])
def test_white_cloud_cannot_be_seen(integrator: str, depth: float) -> None:
    """Albedo 1 under a white sky, whatever the density."""
    cloud = math("multiply", math("maximum", math("subtract", noise(2.0), 0.4), 0.0), 5 * depth)
    scene = Builder(camera((0, -3, 0), (0, 0, 0), 50), environment=sky())
    scene.sphere((0, 0, 0), 1, d.Null(), interior=medium(sigma_s=vector(cloud, math("multiply", cloud, 0.5), cloud)))
    check_radiance(Measurement(scene.done(), integrator, samples=4), 1, within=0.03)


def test_a_cloud_as_warm_as_the_sky_cannot_be_seen(integrator: str) -> None:
    """What is absorbed is emitted: what is reflected, transmitted and absorbed adds up to one."""
    cloud = math("multiply", noise(2.0), 3.0)
    absorbed = vector(math("multiply", cloud, 0.3), math("multiply", cloud, 0.1), 0.2)
    warm = medium(sigma_s=vector(cloud), sigma_a=absorbed, emission=absorbed, g=0.4)
    scene = Builder(camera((0, -3, 0), (0, 0, 0), 50), environment=sky())
    scene.mesh(octahedron((0, 0, 0), 1, splits=1), d.Null(), interior=warm)
    scene.sphere((0.4, 0, 0), 0.3, d.Lambert(WHITE))
    scene.sphere((-0.4, 0.2, 0), 0.3, d.Glass(1.5))
    check_radiance(Measurement(scene.done(), integrator, samples=4), 1, within=0.03)
