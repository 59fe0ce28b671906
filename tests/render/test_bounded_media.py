# SPDX-License-Identifier: GPL-3.0-or-later
"""Media within closed surfaces: transmittance, emission, single scattering and energy."""

from typing import Any

import numpy as np
import pytest

from addon.scene import description as d
from tests.engine.library import Render, Scene
from tests.render import closed_forms as exact
from tests.render.build import (
    BLACK,
    WHITE,
    Builder,
    box,
    camera,
    floor,
    grey,
    look_at,
    octahedron,
    quad,
    radiometer,
    sky,
)
from tests.render.statistics import (
    INTEGRATORS,
    ROUNDING,
    Measurement,
    Pictures,
    blocks,
    check_radiance,
    check_same,
)

pytestmark = pytest.mark.parametrize("integrator", INTEGRATORS)

ALONG = np.array([0.0, 1.0, 0.0])
ROOM = box((-3, -1, -3), (3, 5, 3))  # about the origin, which is in it


def absorber(sigma: float) -> d.Medium:
    return d.Medium(grey(sigma), BLACK)


def along_y(start: float = 0.0, **parts: Any) -> Builder:
    """Along +y, beside all edges of boxes about the axis."""
    return Builder(radiometer((0.03, start, 0.07), (0.03, start + 1, 0.07)), **parts)


def slab(near: float, far: float) -> d.Mesh:
    return box((-1, near, -1.3), (1.1, far, 1))


def through(sigma_lengths: float) -> float:
    return ROUNDING + 4 * sigma_lengths * 2.0**-22


# ---- Transmittance -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("depth", [1e-6, 1e-2, 1, 20])
@pytest.mark.parametrize("start", [0, 4])
def test_slab(integrator: str, depth: float, start: float) -> None:
    """Between 3 and 5; the camera before it or in its middle."""
    scene = along_y(start, environment=sky()).mesh(slab(3, 5), d.Null(), interior=absorber(depth / 2))
    expected = np.exp(-depth * (1 if start == 0 else 0.5))
    check_radiance(Measurement(scene.done(), integrator), expected, within=0, rounding=through(depth))


def test_ball_of_coloured_absorber(integrator: str) -> None:
    sigma = (0.1, 1.0, 4.0)
    scene = along_y(environment=sky()).sphere((0.53, 4, 0.07), 1.3, d.Null(), interior=d.Medium(sigma, BLACK))
    chord = 2 * np.sqrt(1.3**2 - 0.5**2)
    check_radiance(Measurement(scene.done(), integrator), np.exp(-chord * np.array(sigma)), within=1e-3, rounding=1e-5)


def test_media_add_up(integrator: str) -> None:
    """Nested, overlapping, instanced, mirrored, and one that fills all space; a light beyond them."""
    scene = along_y(medium=absorber(0.05)).sphere((0, 22, 0), 2, d.Light(WHITE))
    scene.mesh(slab(1, 6), d.Null(), interior=absorber(0.1))
    scene.mesh(slab(2, 3), d.Null(), interior=absorber(0.4))
    scene.mesh(slab(5, 8), d.Null(), interior=absorber(0.2))
    places = np.stack([np.diag([1.0, 1, 1, 1]), np.diag([-2.0, 3, 2, 1])])
    scene.mesh(slab(3.5, 4.5), d.Null(), instances=places, interior=absorber(0.3))
    reach = 22 - np.sqrt(4 - 0.03**2 - 0.07**2)
    depth = 0.05 * reach + 0.1 * 5 + 0.4 * 1 + 0.2 * 3 + 0.3 * (1 + 3)
    check_radiance(Measurement(scene.done(), integrator), np.exp(-depth), within=1e-4, rounding=through(depth))


def test_shadow_rays(integrator: str) -> None:
    """Through a slab above a plate that a sun lights; the camera looks from below the slab."""
    scene = Builder(radiometer((0, -1, 1), (0, 0, 0))).mesh(floor(), d.Lambert(grey(0.5)))
    scene.mesh(box((-9, -9, 2), (9, 9, 4)), d.Null(), interior=absorber(0.3))
    scene.lamp(d.SunLight("sun", (0, 0.6, -0.8), WHITE, 0))
    expected = 0.5 / np.pi * 0.8 * np.exp(-0.3 * 2 / 0.8)
    check_radiance(Measurement(scene.done(), integrator), expected, within=1e-4, rounding=1e-5)


def test_murky_glass(integrator: str) -> None:
    """A ball of index 1 that absorbs, in fog that is not within it."""
    scene = along_y(medium=absorber(0.1)).sphere((0.03, 12, 0.07), 2, d.Light(WHITE))
    scene.sphere((0.03, 5, 0.07), 1, d.Glass(1), interior=absorber(0.7))
    check_radiance(Measurement(scene.done(), integrator), np.exp(-0.8 - 1.4), within=1e-4, rounding=through(3))


def test_surfaces_within(integrator: str) -> None:
    """A clear surface, and an opaque one of which the camera sees the outside."""
    scene = along_y(environment=sky())
    scene.mesh(slab(2, 4), d.Transparent(grey(0.5)), interior=absorber(0.3))
    scene.mesh(slab(5, 7), d.Light(WHITE), interior=absorber(3))
    check_radiance(Measurement(scene.done(), integrator), 0.25 * np.exp(-0.6), within=0.02, rounding=through(1))


# ---- Emission ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("sigma", [0, 0.4])
def test_emission(integrator: str, sigma: float) -> None:
    shining = d.Medium(grey(sigma), BLACK, emission=(0.1, 0.2, 0))
    scene = along_y(environment=sky(0.5)).mesh(slab(3, 5), d.Null(), interior=shining)
    length = (1 - np.exp(-2 * sigma)) / sigma if sigma else 2
    expected = 0.5 * np.exp(-2 * sigma) + length * np.array([0.1, 0.2, 0])
    check_radiance(Measurement(scene.done(), integrator), expected, within=0, rounding=1e-5)


def test_emission_lights_a_surface(integrator: str) -> None:
    """A thin shining slab all over a plate, as seen from it: radiance 0.1 / cos in every direction."""
    scene = Builder(radiometer((0, -0.3, 0.5), (0, 0, 0))).mesh(floor(), d.Lambert(grey(0.5)))
    shining = d.Medium(BLACK, BLACK, emission=grey(1))
    scene.mesh(box((-500, -500, 1), (500, 500, 1.1)), d.Null(), interior=shining)
    check_radiance(Measurement(scene.done(), integrator, samples=16), 0.5 * 2 * 0.1, within=0.05)


# ---- Scattering ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("start", [0, -6])
@pytest.mark.parametrize("angle", [0, 4])
def test_sun_from_outside(integrator: str, start: float, angle: float) -> None:
    """Light that comes down into a box and is scattered once."""
    if start and angle:
        pytest.skip("one of the two is enough")
    sigma_a, sigma_s, g = 0.05, 0.2, 0.4
    scene = along_y(start).lamp(d.SunLight("sun", (0, 0, -1), WHITE, angle))
    # Of a wide sun nothing that matters may come in by a side: a box so long that its far end is not seen.
    half = 60 if angle else 3
    body = box((-half, -half, -3), (half, half, 3)) if angle else ROOM
    scene.mesh(body, d.Null(), interior=d.Medium(grey(sigma_a), grey(sigma_s), g))
    sigma, length = sigma_a + sigma_s, half if angle else 5 if start == 0 else 6

    def source(cosine: float) -> float:  # of light at an angle from the zenith; the mean over azimuths by symmetry
        azimuth = (np.arange(64) + 0.5) * np.pi / 32
        along = np.sqrt(1 - cosine**2) * np.sin(azimuth)
        return float(exact.henyey_greenstein(g, along).mean() * np.exp(-sigma * 2.93 / cosine))

    if angle == 0:
        scattered = source(1.0)
    else:
        least = np.cos(np.radians(angle / 2))
        x, w = exact.gauss(float(least), 1, 32)
        scattered = sum(w[i] * source(float(x[i])) for i in range(32)) * 2 / (1 - least**2)
    expected = sigma_s * scattered * (1 - np.exp(-sigma * length)) / sigma
    check_radiance(Measurement(scene.done(), integrator, samples=4, max_scatter=1), expected, within=0.04)


@pytest.mark.parametrize("g", [0, 0.8])
def test_lamp_inside(integrator: str, g: float) -> None:
    light = (1, 3, 0)
    scene = Builder(radiometer((0, 0, 0), ALONG)).lamp(d.PointLight("point", light, WHITE))
    scene.mesh(ROOM, d.Null(), interior=d.Medium(grey(0.02), grey(0.08), g))
    expected = exact.point_airlight(0.1, 0.08, g, light, ALONG, 5)
    check_radiance(Measurement(scene.done(), integrator, samples=4, max_scatter=1), expected, within=0.04)


def test_gap(integrator: str) -> None:
    """Two parts of one ray with nothing between, of unlike media, the lamp before the gap."""
    light = (1, 3.5, 0)
    scene = Builder(radiometer((0, 0, 0), ALONG)).lamp(d.PointLight("point", light, WHITE))
    scene.mesh(box((-3, -1, -3), (3, 3, 3)), d.Null(), interior=d.Medium(grey(0.1), grey(0.3), 0.5))
    scene.mesh(box((-3, 4, -3), (3, 6, 3)), d.Null(), interior=d.Medium(BLACK, (0.1, 0.5, 2), -0.3))
    t, w = exact.gauss(0, 3, 200)
    first = sum(
        wi
        * 0.3
        * np.exp(-0.4 * (ti + (3 - ti) / (3.5 - ti) * np.hypot(1, 3.5 - ti)))
        * exact.henyey_greenstein(0.5, (3.5 - ti) / np.hypot(1, 3.5 - ti))
        / (1 + (3.5 - ti) ** 2)
        for ti, wi in zip(t, w, strict=True)
    )
    t, w = exact.gauss(4, 6, 200)
    second = [
        sum(
            wi
            * s
            * np.exp(-0.4 * 3 - s * ((ti - 4) + (ti - 4) / (ti - 3.5) * np.hypot(1, ti - 3.5)))
            * exact.henyey_greenstein(-0.3, -(ti - 3.5) / np.hypot(1, ti - 3.5))
            / (1 + (ti - 3.5) ** 2)
            for ti, wi in zip(t, w, strict=True)
        )
        for s in (0.1, 0.5, 2)
    ]
    measurement = Measurement(scene.done(), integrator, samples=4, max_scatter=1)
    check_radiance(measurement, first + np.array(second), within=0.03)


# ---- Energy --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("depth", [1e-3, 1, 10])
def test_white_ball_cannot_be_seen(integrator: str, depth: float) -> None:
    """Albedo 1 under a white sky."""
    scene = Builder(camera((0, -3, 0), (0, 0, 0), 50), environment=sky())
    scene.sphere((0, 0, 0), 1, d.Null(), interior=d.Medium(BLACK, grey(depth / 2), 0.3 if depth == 1 else 0))
    check_radiance(Measurement(scene.done(), integrator), 1, within=0.03)


@pytest.mark.full
def test_thick_white_ball(integrator: str) -> None:
    scene = Builder(camera((0, -3, 0), (0, 0, 0), 30), environment=sky())
    scene.sphere((0, 0, 0), 1, d.Null(), interior=d.Medium(BLACK, grey(50)))
    check_radiance(Measurement(scene.done(), integrator), 1, within=0.05)


def test_white_bodies_within_each_other(integrator: str) -> None:
    """Of unlike phase functions and a little colour, with white surfaces and glass among them."""
    scene = Builder(camera((0.4, -1, 0.3), (0, 1, 0), 80), environment=sky())
    scene.mesh(ROOM, d.Null(), interior=d.Medium(BLACK, grey(0.1), 0.3))
    scene.mesh(octahedron((0, 1, 0), 1.5, splits=2), d.Null(), interior=d.Medium(BLACK, (0.25, 0.3, 0.2), -0.5))
    scene.sphere((0.5, 1, 0.5), 1, d.Null(), interior=d.Medium(BLACK, grey(0.5)))
    scene.mesh(octahedron((-0.6, 0.6, 0), 0.4), d.Mix(0.5, d.Lambert(WHITE), d.Mirror(WHITE)))
    scene.sphere((0, 0.5, -0.6), 0.3, d.Glass(1.5))
    check_radiance(Measurement(scene.done(), integrator), 1, within=0.05)


def test_a_box_around_everything_is_a_world(integrator: str) -> None:
    fog = d.Medium((0.01, 0.02, 0.0), (0.1, 0.08, 0.15), 0.2)

    def scene(world: bool) -> Pictures:
        parts: dict[str, Any] = {"medium": fog} if world else {}
        made = Builder(camera((0, -4, 1.5), (0, 0, 0.5), 60), **parts)
        made.mesh(floor(), d.Lambert(grey(0.6))).sphere((0.5, 0.3, 0.8), 0.4, d.Light((4, 3, 2)))
        made.sphere((-0.7, 0, 0.5), 0.5, d.Lambert(grey(0.8)))
        if not world:
            made.mesh(box(grey(-60), grey(61)), d.Null(), interior=fog)
        return Pictures(Measurement(made.done(), "path", samples=4))

    if integrator != "path":
        pytest.skip("free flights take minutes to say anything here")
    world, bounded = scene(True), scene(False)
    check_same(lambda seed: blocks(world(seed), 16), lambda seed: blocks(bounded(seed), 16), within=0.06)


@pytest.mark.parametrize("what", ["ball", pytest.param("pane", marks=pytest.mark.full), "drink"])
def test_light_vertices_and_glass(what: str, integrator: str) -> None:
    """A ball and a pane of glass in a room of haze, and a ball of glass that is full of it."""
    if integrator != "path":
        pytest.skip("it has no light vertices")
    scene = Builder(camera((0, -7, 2.2), (0, 0, 1.2), 50), 16, 12)
    scene.mesh(floor(0, 30), d.Lambert(grey(0.5))).sphere((-2, 2, 3), 0.5, d.Light((9, 6, 4)))
    scene.sphere((6, 3, 5), 0.8, d.Light((6, 8, 12)))
    if what == "drink":
        scene.sphere((0, 0, 1.2), 1.2, d.Glass(1.33), interior=d.Medium((0.05, 0.02, 0.3), (1.0, 1.4, 0.6), 0.2))
    else:
        haze = d.Medium((0.01, 0.02, 0.01), (0.2, 0.16, 0.24))
        scene.mesh(box((-4, -3, -0.5), (4, 4, 4)), d.Null(), interior=haze)
    if what == "ball":
        scene.sphere((0.6, 0, 1), 0.9, d.Glass(1.5))
    if what == "pane":
        scene.mesh(box((-3, -1, 0.01), (3, -0.8, 4)), d.Glass(1.5))
    made = scene.done()
    shared, alone = (Pictures(Measurement(made, name, samples=4)) for name in ("path", "path-no-light-vertices"))
    check_same(lambda seed: blocks(shared(seed), 4), lambda seed: blocks(alone(seed), 4), within=0.05, what=what)


CLOUD = np.array([0.0, 0.0, 2.5])
AFAR = 40.0 * np.array([[0.5, -0.4, 0.768], [-0.6, -0.3, 0.742], [0.1, 0.6, 0.794]])
RED, GREEN, BLUE = (np.array([[1, 0.01, 0.01], [0.01, 1, 0.01], [0.01, 0.01, 1]]) * 3).tolist()


def intensity(irradiance: list[float], area: float = 1.0) -> Any:
    """Of a lamp at AFAR; with an area its radiance."""
    return tuple(1600.0 / area * x for x in irradiance)


def shine_afar(scene: Builder, lights: str) -> None:
    """Lights of a kind each, in red, green and blue, that a small cloud sees from far away."""
    red, green, blue = (tuple(center) for center in CLOUD + AFAR)
    if lights == "sun":
        scene.lamp(d.SunLight("sun", (0.5, 0.4, -0.76), (3, 2.8, 2.4), 2))
    if lights == "points":
        scene.lamp(d.PointLight("point", red, intensity(RED)))
        scene.lamp(d.PointLight("disk", green, intensity(GREEN), 4, is_disk=True))
        scene.lamp(d.PointLight("sphere", blue, intensity(BLUE), 4))
    if lights == "surfaces":
        scene.sphere(red, 3, d.Light(intensity(RED, 9 * np.pi)))
        scene.mesh(quad(green, (5, 1, 0), (-1, 5, 1)), d.Light(intensity(GREEN, 24)))
        scene.lamp(d.AreaLight("area", look_at(blue, CLOUD), (4, 6), intensity(BLUE, 24), spread=70))
    if lights == "spots":
        scene.lamp(d.SpotLight("at it", red, tuple(-AFAR[0]), intensity(RED), 20, 0.5))
        scene.lamp(d.SpotLight("beside it", green, tuple(-AFAR[1] + 7), intensity(GREEN), 16, 0.5, 1))
        scene.lamp(d.AreaLight("ellipse", look_at(blue, CLOUD), (4, 6), intensity(BLUE, 19), ellipse=True))


@pytest.mark.parametrize("lights", ["sun", "points", "surfaces", "spots"])
def test_cloud_above_a_wide_plane(lights: str, integrator: str) -> None:
    """Few light subpaths that start as the light shines meet it, or the ground close to it: a quarter of its light was
    in bright spots too rare to be seen."""
    if integrator != "path":
        pytest.skip("it has no light vertices")
    scene = Builder(camera((0, -7, 3), tuple(CLOUD), 30), 12, 8)
    scene.mesh(floor(0, 200), d.Lambert(grey(0.5)))
    shine_afar(scene, lights)
    made = scene.sphere(CLOUD, 1.5, d.Null(), interior=d.Medium(grey(0.02), (0.5, 0.6, 0.8), 0.3)).done()
    shared, alone = (Pictures(Measurement(made, name, samples=4)) for name in ("path", "path-no-light-vertices"))
    check_same(lambda seed: blocks(shared(seed), 4), lambda seed: blocks(alone(seed), 4), within=0.05, what=lights)


# ---- Robustness ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("g", [0, 0.9])
def test_meshes_that_are_not_closed(integrator: str, g: float) -> None:
    """A plane, a box without a lid, one turned inside out and one in itself: pictures without end or fault."""
    fog = d.Medium(grey(0.1), grey(0.5), g)
    lidless, inside_out = box((1, 2, -1), (3, 4, 1)), box((-3, 2, -1), (-1, 4, 1))
    twice = box((-0.5, 4, -0.5), (0.5, 5, 0.5))
    scene = Builder(camera((0, -4, 1), (0, 2, 0), 60), environment=sky())
    scene.mesh(quad((0, 0, 0), (2, 0, 0), (0, 0, 2)), d.Null(), interior=fog)
    scene.mesh(d.Mesh("lidless", lidless.vertices, lidless.triangles[2:]), d.Null(), interior=fog)
    scene.mesh(d.Mesh("inside out", inside_out.vertices, inside_out.triangles[:, ::-1].copy()), d.Null(), interior=fog)
    doubled = np.concatenate([twice.triangles, twice.triangles])
    scene.mesh(d.Mesh("twice", twice.vertices, doubled), d.Null(), interior=fog)
    scene.lamp(d.PointLight("point", (0, 1, 2), WHITE))
    with Render(Scene(scene.done()), integrator=integrator, samples=16, threads=1) as render:
        progress = render.run().poll()
        assert progress.invalid_samples == 0
        picture = render.read()
    assert np.isfinite(picture).all() and (picture >= 0).all()
