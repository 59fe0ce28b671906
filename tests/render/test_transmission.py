# SPDX-License-Identifier: GPL-3.0-or-later
"""Light that passes surfaces: straight through, refracted by rough glass, scattered diffusely, in mixes and sums."""

from collections.abc import Callable

import numpy as np
import pytest

from addon.scene import description as d
from tests.render.build import WHITE, Builder, box, camera, floor, grey, hexagon, octahedron, quad, radiometer, sky
from tests.render.statistics import INTEGRATORS, Measurement, Pictures, blocks, check_radiance, check_same
from tests.render.test_integrators_agree import PLATE, field, plates

FAR = (7.0, -11.0, 5.0)
COLOUR = (0.8, 0.5, 0.2)
ROUGH = d.Glass(1.5, 0.2)
WHITE_MIXES: dict[str, d.Surface] = {
    "glass and diffuse": d.Mix(0.5, d.Glass(1.5), d.Lambert(WHITE)),
    "glass and mirror": d.Mix(0.3, d.Glass(1.5), d.Mirror(WHITE)),
    "glass and clear": d.Mix(0.5, d.Glass(1.5), d.Transparent(WHITE)),
    "glass and translucent": d.Mix(0.5, d.Glass(1.5), d.Translucent(WHITE)),
    "two glasses": d.Mix(0.5, d.Glass(1.5), d.Glass(1.5, alpha=0.0)),
    "clear": d.Transparent(WHITE),
    "half there": d.Mix(0.5, d.Transparent(WHITE), d.Lambert(WHITE)),
    "translucent": d.Translucent(WHITE),
    "paper": d.Mix(0.5, d.Translucent(WHITE), d.Lambert(WHITE)),
    "a sum": d.Add(d.Transparent(grey(0.25)), d.Add(d.Lambert(grey(0.25)), d.Translucent(grey(0.5)))),
    "facets": d.Lambert(WHITE, roughness=0.8, facets="multiple"),
    "emission": d.Mix(0.5, d.Transparent(grey(0.5)), d.Lambert(grey(0.5)), emission=grey(0.5)),
}


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("name", WHITE_MIXES)
def test_white_furnace(integrator: str, name: str) -> None:
    scene = Builder(camera(FAR, (0, 0, 0), 25), environment=sky())
    scene.sphere((0, 0, 0), 2, WHITE_MIXES[name]).mesh(octahedron((2, 2, 0), 1), WHITE_MIXES[name])
    check_radiance(Measurement(scene.done(), integrator), 1, within=0.02, rounding=2e-5)


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("alpha", [0.005, 0.02])
def test_rough_glass_grows_smooth(integrator: str, alpha: float) -> None:
    """What single scattering between facets loses goes with the square of their width."""
    scene = Builder(camera(FAR, (0, 0, 0), 25), environment=sky()).sphere((0, 0, 0), 2, d.Glass(1.5, alpha))
    check_radiance(Measurement(scene.done(), integrator), 1, within=0.02, rounding=4 * alpha)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_colour_of_panes(integrator: str) -> None:
    """Straight through two panes; and down to a white floor past one, from a lamp without size and from a sky."""
    seen = Builder(radiometer((0, 0, 5), (0, 0, 0)), environment=sky())
    seen.mesh(floor(0), d.Transparent(COLOUR)).mesh(floor(-1), d.Transparent(COLOUR))
    check_radiance(Measurement(seen.done(), integrator), [c * c for c in COLOUR], within=0.01)
    shadow = Builder(radiometer((8, 0, 2), (0, 0, 0)))
    shadow.mesh(floor(0), d.Lambert(WHITE)).mesh(quad((0, 0, 1), (1, 0, 0), (0, 1, 0)), d.Transparent(COLOUR))
    shadow.lamp(d.PointLight("lamp", (0, 0, 2), grey(4 * np.pi)))
    check_radiance(Measurement(shadow.done(), integrator), COLOUR, within=0.01)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_translucent_floor(integrator: str) -> None:
    """Lit from below by a lamp without size, seen from above: albedo / pi I / d^2; and nothing seen from below."""
    lamp = d.PointLight("lamp", (0, 0, -2), grey(4 * np.pi))
    for height, expected in ((5, COLOUR), (-5, (0, 0, 0))):
        scene = Builder(radiometer((3, 0, height), (0, 0, 0))).mesh(floor(0), d.Translucent(COLOUR)).lamp(lamp)
        check_radiance(Measurement(scene.done(), integrator), expected, within=0.01)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_refraction_alone(integrator: str) -> None:
    """A slab that refracts all light that it can passes all of it; coloured, the square of its colour."""
    glass = d.Glass(1.5, transmission=COLOUR, lobes="refraction")
    scene = Builder(radiometer((4, 0, 3), (0, 0, 0)), environment=sky()).mesh(box((-30, -29, -1), (31, 30, 0)), glass)
    check_radiance(Measurement(scene.done(), integrator), [c * c for c in COLOUR], within=0.01, rounding=1e-5)


def clear_panes(scene: Builder) -> Builder:
    """Panes that are as good as not there, where the camera, the lights and the light vertices look."""
    clear = d.Transparent(WHITE)
    scene.mesh(quad((0, -2, 3), (6, 0, 0), (0, 0.5, 4)), clear).mesh(quad((0, 6, 2), (9, 0, 0.5), (0, 1, 9)), clear)
    scene.mesh(quad((0, 8, 1.6), (20, 0, 0), (0, 20, 0.2)), clear).sphere((0, 8, 2), 3, clear)
    return scene.mesh(octahedron((1, 1, 3), 1), clear)


HAZE = d.Medium(grey(0.01), grey(0.06))
CLEARED: dict[str, Callable[[], Builder]] = {
    "field": lambda: field(None),
    "field in fog": lambda: field(HAZE),
    "smooth metal in fog": lambda: field(HAZE, d.Conductor(0.05, f0=grey(0.8))),
}


@pytest.mark.parametrize("integrator", ["path", "baseline"])
@pytest.mark.parametrize("name", CLEARED)
def test_clear_panes_change_nothing(name: str, integrator: str) -> None:
    with_panes = Pictures(Measurement(clear_panes(CLEARED[name]()).done(), integrator, samples=2))
    without = Pictures(Measurement(CLEARED[name]().done(), integrator, samples=2))
    check_same(lambda seed: blocks(with_panes(seed), 8), lambda seed: blocks(without(seed), 8), within=0.08, what=name)


def things_in_fog(material: d.Surface, medium: d.Medium | None = HAZE) -> Builder:
    """A ball, a standing pane and some plates of it, before plates of metal and three moons."""
    scene = field(medium)
    scene.sphere((-0.5, 5, 1.6), 1, material).mesh(octahedron((2, 4, 1), 0.8), material)
    if not isinstance(material, d.Glass):
        scene.mesh(quad((1.5, 7, 2), (1.5, 0.3, 0), (0, 0.4, 1)), material)
    return scene


MATERIALS: dict[str, d.Surface] = {
    "rough glass": ROUGH,
    "glass and diffuse": d.Mix(0.5, d.Glass(1.5), d.Lambert(COLOUR)),
    "rough glass and metal": d.Mix(0.5, d.Glass(1.4, 0.3, reflection=COLOUR, transmission=COLOUR), PLATE),
    "translucent": d.Translucent(COLOUR),
    "paper": d.Mix(0.5, d.Translucent(COLOUR), d.Conductor(0.15, f0=COLOUR)),
    "half there": d.Mix(0.5, d.Transparent(COLOUR), d.Conductor(0.1, f0=COLOUR)),
    "rough diffuse": d.Lambert(COLOUR, roughness=1.0),
}


@pytest.mark.parametrize("fog", [False, True], ids=["clear", "fog"])
@pytest.mark.parametrize("name", MATERIALS)
def test_both_integrators(name: str, fog: bool) -> None:
    scene = things_in_fog(MATERIALS[name], HAZE if fog else None).done()
    path, baseline = (Pictures(Measurement(scene, integrator, samples=2)) for integrator in ("path", "baseline"))
    check_same(lambda seed: blocks(path(seed), 8), lambda seed: blocks(baseline(seed), 8), within=0.08, what=name)


def test_bent_normals() -> None:
    """Smooth normals on coarse plates that pass light, in fog: camera and light paths agree on the frame."""
    scene = Builder(camera((0, -4, 4), (0, 8, 1.5), 60), 32, 24, medium=HAZE)
    scene.mesh(hexagon(1, 0.3), d.Mix(0.5, d.Translucent(COLOUR), d.Conductor(0.1, f0=COLOUR)), instances=plates())
    scene.sphere((0.5, 8, -2), 0.8, d.Light(grey(5))).sphere((0, 9, 3), 0.8, d.Light(grey(1)))
    path, baseline = (Pictures(Measurement(scene.done(), name, samples=2)) for name in ("path", "baseline"))
    check_same(lambda seed: blocks(path(seed), 8), lambda seed: blocks(baseline(seed), 8), within=0.08, what="plates")
