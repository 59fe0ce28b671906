# SPDX-License-Identifier: GPL-3.0-or-later
"""Mirrors and glass: what a chain of them leaves of a light is a product or a geometric series."""

from dataclasses import replace

import numpy as np
import pytest

from addon.native.structs import State
from addon.scene import description as d
from tests.engine.library import Render, Scene
from tests.render import closed_forms as exact
from tests.render.build import BLACK, WHITE, Builder, box, camera, faces_apart, floor, grey, quad, radiometer, sky
from tests.render.statistics import INTEGRATORS, Measurement, check_radiance

pytestmark = pytest.mark.parametrize("integrator", INTEGRATORS)


@pytest.mark.parametrize("metal", [False, True])
@pytest.mark.parametrize("bounces", [1, 5, 20])
def test_mirror_corridor(integrator: str, bounces: int, metal: bool) -> None:
    """Two mirrors face to face, a light at the end: reflectance^n. One channel is lossless, so no path ends early."""
    colour = (1.0, 0.9, 0.5)
    mirror: d.Surface = d.Conductor(0, f0=colour) if metal else d.Mirror(colour)
    slope = 1e-2 if metal else 1.0  # all but straight on, where Schlick's Fresnel is f0
    end = 2 * slope * bounces
    scene = Builder(radiometer((0, 0, 0), (1, slope, 0)))
    for x in (1, -1):
        scene.mesh(quad((x, end / 2, 0), (0, end, 0), (0, 0, 2)), mirror)
    scene.mesh(quad((0, end, 0), (1, 0, 0), (0, 0, 2)), d.Light((1, 2, 3)))
    expected = np.array(colour) ** bounces * [1, 2, 3]
    # Schlick at a slope of 0.01: (1 - cos)^5 = 3e-22. A bounce is two roundings.
    check_radiance(Measurement(scene.done(), integrator), expected, within=0, rounding=(64 + 4 * bounces) * 2.0**-24)


def test_grey_corridor(integrator: str) -> None:
    """The same by Russian roulette."""
    scene = Builder(radiometer((0, 0, 0), (1, 1, 0)))
    for x in (1, -1):
        scene.mesh(quad((x, 10, 0), (0, 20, 0), (0, 0, 2)), d.Mirror(grey(0.9)))
    scene.mesh(quad((0, 40, 0), (1, 0, 0), (0, 0, 2)), d.Light(WHITE))
    scene.mesh(quad((1, 35, 0), (0, 5, 0), (0, 0, 2)), d.Mirror(grey(0.9)))
    scene.mesh(quad((-1, 35, 0), (0, 5, 0), (0, 0, 2)), d.Mirror(grey(0.9)))
    check_radiance(Measurement(scene.done(), integrator), 0.9**20, within=0.03)


def test_plate_lit_by_way_of_nothing(integrator: str) -> None:
    """A mirror's view of a lit plate: the plate's radiance times the reflectance, whatever light does on it."""
    scene = Builder(radiometer((0, 0, 4), (0, 3, 4))).mesh(quad((0, 3, 4), (1, 0, 0), (0, 1, -1)), d.Mirror(grey(0.7)))
    scene.mesh(floor(center=(0, 3)), d.Lambert(grey(0.5))).lamp(d.PointLight("point", (0, -2, 3), WHITE))
    # From (0, 3, 4) the ray goes straight down to (0, 3, 0).
    way = np.sqrt(25 + 9)
    expected = 0.7 * 0.5 / np.pi * 3 / way**3
    check_radiance(Measurement(scene.done(), integrator), expected, within=0.02)


@pytest.mark.parametrize("ior", [1.5, 2.4, 1 / 1.3])
@pytest.mark.parametrize("cosine", [1, 0.7])
def test_slab(integrator: str, cosine: float, ior: float) -> None:
    """Reflections inside it without end: T = (1 - R) / (1 + R) of what is behind, 2 R / (1 + R) of what is before."""
    direction = np.array([0, np.sqrt(1 - cosine**2), -cosine])
    scene = Builder(radiometer(-5 * direction, (0, 0, 0))).mesh(box((-30, -29, -1), (31, 30, 0)), d.Glass(ior))
    scene.mesh(floor(-40, 400), d.Light((1, 0, 1))).mesh(floor(40, 400), d.Light((0, 1, 1)))
    r = exact.fresnel(cosine, ior)
    expected = [(1 - r) / (1 + r), 2 * r / (1 + r), 1]
    check_radiance(Measurement(scene.done(), integrator, samples=16), expected, within=0.03)


@pytest.mark.parametrize("degrees", [41, 43, 60])
def test_total_internal_reflection(integrator: str, degrees: float) -> None:
    """From within glass of index 1.5 nothing is seen through its face beyond 41.8 degrees: it is a perfect mirror."""
    angle = np.radians(degrees)
    eye = np.array([0, -np.tan(angle), -1])
    scene = Builder(radiometer(eye, (0, 0, 0)), environment=sky(1)).mesh(
        box((-50, -51, -50), (52, 50, 0)), d.Glass(1.5)
    )
    scene.sphere((0, 3 * np.tan(angle), -3), 1, d.Light((2, 0, 1)))
    inside = np.array([2, 0, 1.0])
    if degrees > 41.9:
        check_radiance(Measurement(scene.done(), integrator), inside, within=0)
        return
    # Below it, by the reversibility of light: R is that of the outer side.
    r = exact.fresnel(np.sqrt(1 - (1.5 * np.sin(angle)) ** 2), 1.5)
    check_radiance(Measurement(scene.done(), integrator), r * inside + (1 - r), within=0.02, rounding=1e-3)


def test_nested_glass_meets_the_right_index(integrator: str) -> None:
    """Glass of 1.5 within glass of 1.5 is not there: the light behind is dimmed by the outer walls alone."""
    scene = Builder(radiometer((0, 0, 5), (0, 0, 0))).mesh(box((-30, -29, -6), (31, 30, 0)), d.Glass(1.5))
    scene.mesh(box((-10, -9, -4), (11, 10, -2)), d.Glass(1.5)).mesh(floor(-40, 400), d.Light(WHITE))
    r = exact.fresnel(1, 1.5)
    check_radiance(Measurement(scene.done(), integrator), (1 - r) / (1 + r), within=0.02)


def test_light_within_glass(integrator: str) -> None:
    """Straight out of glass: (1 - R) of it; a black plate behind takes what is reflected."""
    scene = Builder(radiometer((0, 0, 5), (0, 0, 0))).mesh(box((-30, -29, -6), (31, 30, 0)), d.Glass(1.5))
    scene.mesh(quad((0.1, 0, -3), (20, 0, 0), (0, 20, 0)), d.Light(WHITE))
    check_radiance(Measurement(scene.done(), integrator), 1 - exact.fresnel(1, 1.5), within=0.01)


BEFORE, BEHIND = np.array([1, 0, 20.0]), np.array([1, 1, 1.0])  # what is reflected is little, and counts


def between_lights(scene: Builder, side: int = 1) -> Builder:
    """Seen from above or, at a side of -1, from beneath."""
    return scene.mesh(floor(-40 * side, 400), d.Light(tuple(BEHIND))).mesh(
        floor(40 * side, 400), d.Light(tuple(BEFORE))
    )


@pytest.mark.parametrize("ior", [1.33, pytest.param(1.5, marks=pytest.mark.full), 1 / 1.3])
@pytest.mark.parametrize("cosine", [pytest.param(1, marks=pytest.mark.full), 0.7])
def test_sheet(integrator: str, cosine: float, ior: float) -> None:
    """A single face of glass, from its front and, along the refracted ray, from its back: what is behind it keeps its
    radiance, but for what is reflected, which is the same from both sides."""
    r = exact.fresnel(cosine, ior)
    sine = np.sqrt(1 - cosine**2)
    for side, s in ((1, sine), (-1, sine / ior)):
        eye = (0, -5 * s, 5 * side * np.sqrt(1 - s**2))
        scene = between_lights(Builder(radiometer(eye, (0, 0, 0))).mesh(floor(0, 30), d.Glass(ior)), side)
        check_radiance(Measurement(scene.done(), integrator), r * BEFORE + (1 - r) * BEHIND, within=0.03)


def test_sheets_in_a_row(integrator: str) -> None:
    """Each of two sheets is met from air: T = (1 - R1) (1 - R2) / (1 - R1 R2) of what is behind."""
    first, second, cosine = 1.5, 1.7, 0.5
    sine = np.sqrt(1 - cosine**2)
    scene = Builder(radiometer((0, -5 * sine, 5 * cosine), (0, 0, 0))).mesh(floor(0, 30), d.Glass(first))
    between_lights(scene.mesh(floor(-1, 30), d.Glass(second)))
    r1, r2 = exact.fresnel(cosine, first), exact.fresnel(np.sqrt(1 - (sine / first) ** 2), second)
    through = (1 - r1) * (1 - r2) / (1 - r1 * r2)
    expected = through * BEHIND + (1 - through) * BEFORE
    check_radiance(Measurement(scene.done(), integrator), expected, within=0.02)


@pytest.mark.parametrize("shape", ["whole", "apart", "without a floor", "inside out"])
def test_what_encloses_a_body(integrator: str, shape: str) -> None:
    """Glass of 1.5 within a box of it is not there, but by a box that is not closed, or whose normals point inward,
    each of its faces is met from air."""
    around = box((-30, -29, -6), (31, 30, 0))
    around = {
        "whole": around,
        "apart": faces_apart(around),
        "without a floor": replace(around, triangles=around.triangles[2:]),
        "inside out": replace(around, triangles=around.triangles[:, ::-1]),
    }[shape]
    scene = Builder(radiometer((0, 0, 5), (0, 0, 0))).mesh(around, d.Glass(1.5))
    scene.mesh(box((-10, -9, -4), (11, 10, -2)), d.Glass(1.5)).mesh(floor(-40, 400), d.Light(WHITE))
    faces = {"whole": 2, "apart": 2, "without a floor": 3, "inside out": 4}[shape]
    ratio = exact.fresnel(1, 1.5) / (1 - exact.fresnel(1, 1.5))  # of what a face reflects to what it lets pass
    check_radiance(Measurement(scene.done(), integrator), 1 / (1 + faces * ratio), within=0.02)


def test_black_surfaces(integrator: str) -> None:
    """Nothing at all comes from where nothing is."""
    scene = Builder(radiometer((0, 0, 5), (0, 0, 0)), environment=sky()).mesh(floor(), d.Lambert(BLACK))
    check_radiance(Measurement(scene.done(), integrator, samples=8), 0, within=0)


def test_total_reflection_without_end(integrator: str) -> None:
    """Across a ball of glass far off its middle, seen from within and lit from within: nothing gets out, and every path
    must find that out in the end."""
    scene = Builder(camera((0, -4, 1), (0, 4, 1), 10), 4, 4, medium=d.Medium(grey(0.02), grey(0.15)))
    scene.sphere((0.9, -4, 1), 1, d.Glass(1.5)).lamp(d.PointLight("ball", (0.9, -4, 1), WHITE, radius=0.95))
    with Render(Scene(scene.done()), integrator=integrator, samples=1, threads=1) as render:
        render.start()
        render.wait(30)
        assert render.poll().state == State.FINISHED
        assert render.report()["biased_by"] == []
