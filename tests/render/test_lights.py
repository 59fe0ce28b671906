# SPDX-License-Identifier: GPL-3.0-or-later
"""Light that falls on a plate: every kind of light against the closed form of its irradiance."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import ArrayLike, NDArray

from addon.scene import description as d
from tests.render import closed_forms as exact
from tests.render.build import BLACK, WHITE, Builder, at, floor, grey, octahedron, quad, radiometer, sky, unit
from tests.render.statistics import INTEGRATORS, ROUNDING, Measurement, check_radiance

pytestmark = pytest.mark.parametrize("integrator", INTEGRATORS)

ALBEDO = (0.8, 0.5, 0.2)
COLOR = (1.0, 2.0, 3.0)
FLUX = np.array(ALBEDO) * COLOR / np.pi
"""Radiance of the plate per irradiance of a light of colour COLOR."""
EXACT = 1e-4
"""Where every sample is the same but for the width of the view."""


def plate(eye: ArrayLike = (0.3, -2, 0.7), **parts: Any) -> Builder:
    """A large plate at z = 0 seen at the origin."""
    return Builder(radiometer(eye, (0, 0, 0)), **parts).mesh(floor(), d.Lambert(ALBEDO))


def frame(center: ArrayLike, target: ArrayLike) -> NDArray[Any]:
    """to_world of a lamp that shines along its -z from center to target."""
    back = unit(np.asarray(center, float) - np.asarray(target, float))
    x = unit(np.cross((0.3, 0.9, 0.1), back))
    matrix = np.eye(4)
    matrix[:3, :3] = np.stack([x, np.cross(back, x), back], axis=1)
    matrix[:3, 3] = center
    return matrix


# ---- Spheres ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("sine", "theta"),
    [(0.5, 0), (0.3, 0.7), (0.9, 0.3), (0.99, 0), (0.5, 1.3), (0.5, 1.8), (0.9, 1.0), (0.01, 1.5707), (0.2, 1.7)],
)
def test_sphere(integrator: str, sine: float, theta: float) -> None:
    """Overhead, oblique, almost touching, and cut by the horizon, centre above and below it."""
    if theta > np.pi / 2:  # a plate so small that the light beneath its horizon is not cut by it
        scene = Builder(radiometer((0.3, -2, 0.7), (0, 0, 0))).mesh(floor(half=1e-3), d.Lambert(ALBEDO))
    else:  # the eye within the gap
        scene = plate(eye=(-0.02, -0.03, 0.02)) if sine > 0.8 else plate()
    scene.sphere(10 * at(theta), 10 * sine, d.Light(COLOR))
    check_radiance(
        Measurement(scene.done(), integrator, samples=4), FLUX * exact.sphere_irradiance(sine, theta), within=0.02
    )


@pytest.mark.parametrize("sine", [1e-2, 1e-4, 1e-6])
def test_tiny_sphere(integrator: str, sine: float) -> None:
    """1 - cos of its cone is lost in float32: every sample counts the same, so this is exact but for rounding."""
    light = d.Light(tuple(np.array(COLOR) / sine**2))
    scene = Builder(radiometer((0.3, -2, 0.7), (0, 0, 0))).mesh(floor(half=1000), d.Lambert(ALBEDO))
    expected = FLUX * np.pi * np.cos(0.5)
    # Rounding: the hit on so large a plate, as seen from the light.
    check_radiance(
        Measurement(scene.sphere(10 * at(0.5), 10 * sine, light).done(), integrator),
        expected,
        within=0.5 * sine + EXACT,
        rounding=1000 * 2.0**-24,
    )


def test_plates_have_two_sides(integrator: str) -> None:
    scene = plate(eye=(0.3, -2, -0.7)).sphere(-10 * at(0.5), 3, d.Light(COLOR))
    expected = FLUX * exact.sphere_irradiance(0.3, 0.5)
    check_radiance(Measurement(scene.done(), integrator), expected, within=0.01)


def test_no_light_through_a_plate(integrator: str) -> None:
    """Exactly none, from every kind of light."""
    scene = plate(eye=(0.3, -2, -0.7)).sphere((0, 0, 10), 3, d.Light(COLOR))
    scene.mesh(octahedron((5, 0, 5), 1), d.Light(COLOR))
    scene.lamp(d.PointLight("point", (1, 2, 3), COLOR)).lamp(d.PointLight("ball", (-3, 0, 3), COLOR, radius=1))
    scene.lamp(d.SpotLight("spot", (0, 0, 3), (0, 0, -1), COLOR, 60, 0.5))
    scene.lamp(d.AreaLight("area", frame((0, 1, 2), (0, 0, 0)), (1, 1), COLOR))
    scene.lamp(d.SunLight("sun", (0, 0, -1), COLOR, 0.5))
    check_radiance(Measurement(scene.done(), integrator, samples=16), 0, within=0)


def test_shadow(integrator: str) -> None:
    """Half of a light behind a screen whose edge runs through its centre."""
    scene = plate().sphere((0, 0, 10), 2, d.Light(COLOR))
    scene.mesh(quad((50, 0, 5), (50, 0, 0), (0, 50, 0)), d.Lambert(BLACK))
    expected = FLUX * exact.sphere_irradiance(0.2, 0) / 2
    check_radiance(Measurement(scene.done(), integrator, samples=4), expected, within=0.02)


@pytest.mark.parametrize("count", [3, 40, 1000])
def test_many_spheres(integrator: str, count: int) -> None:
    """Chosen one by one, by weight and by the table of strengths: the sum is the same."""
    rng = np.random.default_rng(count)
    theta, azimuth = rng.uniform(0, 1.2, count), rng.uniform(0, 6.28, count)
    distance = rng.uniform(5, 20, count)
    centers = distance[:, None] * np.stack([at(t, p) for t, p in zip(theta, azimuth, strict=True)])
    gap = np.linalg.norm(centers[:, None] - centers[None], axis=2) + 1e9 * np.eye(count)
    radii = np.minimum(gap.min(axis=1) * 0.3, 0.5)
    angles = unit_gaps(centers)
    sines = np.minimum(radii / distance, 0.49 * angles)  # none hides another
    scene = plate(eye=(0.02, -0.05, 0.03)).spheres(centers, sines * distance, d.Light(COLOR))
    expected = FLUX * np.pi * (sines**2 * np.cos(theta)).sum()
    check_radiance(Measurement(scene.done(), integrator, samples=4), expected, within=0.02)


def unit_gaps(centers: NDArray[Any]) -> NDArray[Any]:
    """Sine of the angle to the nearest other direction."""
    w = centers / np.linalg.norm(centers, axis=1, keepdims=True)
    gap: NDArray[Any] = (np.linalg.norm(w[:, None] - w[None], axis=2) + 10 * np.eye(len(w))).min(axis=1)
    return np.minimum(gap, 1)


# ---- Meshes --------------------------------------------------------------------------------------------------------

CENTER, HALF_U, HALF_V = np.array([0.5, -1.0, 3.0]), np.array([1.0, 0, 0.4]), np.array([0.2, 1.5, -0.1])
CORNERS = [CENTER - HALF_U - HALF_V, CENTER + HALF_U - HALF_V, CENTER + HALF_U + HALF_V, CENTER - HALF_U + HALF_V]


@pytest.mark.parametrize("turned", [False, True])
def test_mesh_light(integrator: str, turned: bool) -> None:
    """A tilted parallelogram; both sides shine."""
    scene = plate(eye=(-3, 2, 1.5))
    scene.mesh(quad(CENTER, HALF_U, -HALF_V if turned else HALF_V), d.Light(COLOR))
    check_radiance(
        Measurement(scene.done(), integrator, samples=4), FLUX * exact.polygon_irradiance(CORNERS), within=0.02
    )


def test_mesh_light_body(integrator: str) -> None:
    """A closed body: its faces hide each other. The polygon of its outline is a cube's seen along the diagonal."""
    scene = plate(eye=(-3, 2, 1.5)).mesh(octahedron((0, 0, 4), 1), d.Light(COLOR))
    outline = [(1, 0, 4), (0, 1, 4), (-1, 0, 4), (0, -1, 4)]
    check_radiance(
        Measurement(scene.done(), integrator, samples=4), FLUX * exact.polygon_irradiance(outline), within=0.02
    )


def test_instances_of_a_mesh_light(integrator: str) -> None:
    """Two in their places, one of them scaled: areas follow."""
    place = np.tile(np.eye(4), (2, 1, 1))
    place[0, :3, 3] = (2, 0, 4)
    place[1, :3, :3] = np.diag([3.0, 0.5, 1])
    place[1, :3, 3] = (-4, 1, 3)
    scene = plate(eye=(0, -3, 1.5)).mesh(quad((0, 0, 0), (1, 0, 0), (0, 1, 0)), d.Light(COLOR), instances=place)
    total = 0.0
    for m in place:
        corners = [(m @ (x, y, 0, 1))[:3] for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        total += exact.polygon_irradiance(corners)
    check_radiance(Measurement(scene.done(), integrator, samples=4), FLUX * total, within=0.02)


def test_shining_lambert_lights_others(integrator: str) -> None:
    """Emission of a surface that also reflects; beside it nothing, so it reflects only the plate: kept black there."""
    scene = Builder(radiometer((-3, 2, 1.5), (0, 0, 0))).mesh(floor(half=1e-3), d.Lambert(ALBEDO))
    scene.mesh(quad(CENTER, HALF_U, HALF_V), d.Lambert(grey(0.5), emission=COLOR))
    expected = FLUX * exact.polygon_irradiance(CORNERS)
    check_radiance(Measurement(scene.done(), integrator, samples=4), expected, within=0.02, rounding=1e-5)


# ---- Lamps ---------------------------------------------------------------------------------------------------------


def test_point(integrator: str) -> None:
    """I cos / d^2, exactly."""
    scene = plate().lamp(d.PointLight("point", tuple(3 * at(0.6)), COLOR))
    check_radiance(Measurement(scene.done(), integrator), FLUX * np.cos(0.6) / 9, within=EXACT)


def test_point_with_a_radius(integrator: str) -> None:
    """A see-through ball of radiance I / (pi r^2): far away all the same."""
    scene = plate().lamp(d.PointLight("ball", tuple(3 * at(0.6)), COLOR, radius=0.5))
    scene.sphere(3 * at(0.6), 0.2, d.Null())
    check_radiance(Measurement(scene.done(), integrator), FLUX * np.cos(0.6) / 9, within=0.01)


@pytest.mark.parametrize("angle", [0, 0.2, 0.4, 0.5, 0.51, 0.55, 0.7])
@pytest.mark.parametrize("blend", [0, 0.3, 1])
def test_spot(integrator: str, blend: float, angle: float) -> None:
    """A cone of 60 degrees, seen at angles within, in the soft edge and beyond."""
    position = np.array([0, 0, 3.0])
    axis = np.array([np.sin(angle), 0, -np.cos(angle)])
    scene = plate().lamp(d.SpotLight("spot", tuple(position), tuple(2 * axis), COLOR, 60, blend))
    expected = FLUX * exact.spot_falloff(angle, 60, blend) / 9
    # Two cosines, each of a few roundings, are subtracted, and the difference is squared.
    rounding = ROUNDING + 2 * 8 * 2.0**-24 / abs(np.cos(angle) - np.cos(np.pi / 6))
    check_radiance(Measurement(scene.done(), integrator), expected, within=EXACT, rounding=rounding)


@pytest.mark.parametrize(("angle", "theta"), [(0, 0), (0, 1.2), (0.5, 0.3), (0.5, 1.2), (60, 0.8)])
def test_sun(integrator: str, angle: float, theta: float) -> None:
    """Irradiance at normal incidence times the cosine, whatever its disk."""
    scene = plate().lamp(d.SunLight("sun", tuple(-3 * at(theta)), COLOR, angle))
    check_radiance(Measurement(scene.done(), integrator), FLUX * np.cos(theta), within=0.01)


@pytest.mark.parametrize("ellipse", [False, True])
@pytest.mark.parametrize("distance", [1, 4])
def test_area(integrator: str, distance: float, ellipse: bool) -> None:
    """Radiance all over, from its front alone; invisible to the camera, which looks through it."""
    center = distance * at(0.5)
    matrix = frame(center, (0.2, 0.3, 0))
    scene = plate(eye=8 * at(0.5)).lamp(d.AreaLight("area", matrix, (0.8, 0.5), COLOR, ellipse))
    irradiance = exact.surface_irradiance(center, 0.4 * matrix[:3, 0], 0.25 * matrix[:3, 1], ellipse)
    check_radiance(Measurement(scene.done(), integrator, samples=4), FLUX * irradiance, within=0.02)


def test_back_of_an_area_light(integrator: str) -> None:
    center = 3 * at(0.5)
    scene = plate().lamp(d.AreaLight("area", frame(center, 2 * center), (2, 2), COLOR))
    check_radiance(Measurement(scene.done(), integrator, samples=16), 0, within=0)


@pytest.mark.parametrize("theta", [0, 0.6])
@pytest.mark.parametrize("radius", [1e-3, 0.5, 2.5])
def test_disk_that_faces_the_receiver(integrator: str, radius: float, theta: float) -> None:
    """A cone of the half angle atan(r/d), all of it above the horizon."""
    scene = plate().lamp(d.PointLight("disk", tuple(3 * at(theta)), COLOR, radius, is_disk=True))
    expected = FLUX * np.cos(theta) / (9 + radius**2)
    check_radiance(Measurement(scene.done(), integrator, samples=4), expected, within=0.02)


def test_disk_is_met_by_rays(integrator: str) -> None:
    """A mirror shows its radiance within that cone and nothing beside it."""
    for sine, expected in ((0.29, np.array(COLOR) / (np.pi * 0.9**2)), (0.31, np.zeros(3))):
        eye = np.array([sine, 0, np.sqrt(1 - sine**2)])
        scene = Builder(radiometer(eye, (0, 0, 0))).mesh(floor(), d.Mirror(WHITE))
        radius = 3 * np.tan(np.arcsin(0.3))
        scene.lamp(d.PointLight("disk", (0, 0, 3), tuple(np.array(COLOR) * (radius / 0.9) ** 2), radius, is_disk=True))
        check_radiance(Measurement(scene.done(), integrator), expected, within=EXACT if sine < 0.3 else 0)


@pytest.mark.parametrize("angle", [0, 0.4, 0.5])
@pytest.mark.parametrize("radius", [0, 1e-3])
def test_spot_that_is_darker_by_the_cosine(integrator: str, radius: float, angle: float) -> None:
    axis = (np.sin(angle), 0, -np.cos(angle))
    scene = plate()
    scene.lamp(d.SpotLight("spot", (0, 0, 3), axis, COLOR, 60, 0.3, radius, is_disk=True, times_cosine=True))
    expected = FLUX * exact.spot_falloff(angle, 60, 0.3) * np.cos(angle) / 9
    rounding = ROUNDING + 2 * 8 * 2.0**-24 / abs(np.cos(angle) - np.cos(np.pi / 6)) + 4 * radius**2
    check_radiance(Measurement(scene.done(), integrator, samples=4), expected, within=0.02, rounding=rounding)


@pytest.mark.parametrize(("angle", "theta"), [(0.5, 0.3), (60, 0.8), (90, 0.5)])
def test_sun_of_a_tangent_disk(integrator: str, angle: float, theta: float) -> None:
    """Every point of the disk brings the same, times the cosine of its own direction."""
    scene = plate().lamp(d.SunLight("sun", tuple(-3 * at(theta)), COLOR, angle, is_tangent=True))
    r2 = np.tan(np.radians(angle / 2)) ** 2
    expected = FLUX * np.cos(theta) * 2 * (np.sqrt(1 + r2) - 1) / r2
    check_radiance(Measurement(scene.done(), integrator, samples=4), expected, within=0.02)


@pytest.mark.parametrize("ellipse", [False, True])
@pytest.mark.parametrize("spread", [10, 60, 150])
def test_spread(integrator: str, spread: float, ellipse: bool) -> None:
    """Integrated over the lamp, all of which sends light to the place, or a part of it."""
    center, size = np.array([0.3, 0.2, 2.0]), (0.8, 0.5)
    matrix = frame(center, (0.1, 0.1, 0))
    scene = plate().lamp(d.AreaLight("area", matrix, size, COLOR, ellipse, spread))
    u, v = np.meshgrid(*2 * [(np.arange(400) + 0.5) / 200 - 1])
    points = center + u[..., None] * size[0] / 2 * matrix[:3, 0] + v[..., None] * size[1] / 2 * matrix[:3, 1]
    d2 = (points**2).sum(-1)
    cosine = (points @ matrix[:3, 2]) / np.sqrt(d2)
    half = np.radians(spread / 2)
    dimmed = np.maximum(1 - np.tan(np.arccos(cosine)) / np.tan(half), 0) / (1 - half / np.tan(half))
    within = (u**2 + v**2 <= 1) if ellipse else np.ones_like(u)
    total = (dimmed * within * cosine * points[..., 2] / np.sqrt(d2) / d2).mean() * size[0] * size[1]
    check_radiance(Measurement(scene.done(), integrator, samples=4), FLUX * total, within=0.03, rounding=1e-3)


def test_spread_keeps_the_power(integrator: str) -> None:
    """A ceiling of slats over a wide plate: as bright as without, where all of its light goes."""
    for spread in (30, 179.9):
        matrix = frame((0, 0, 1), (0, 0, 0))
        scene = plate().lamp(d.AreaLight("area", matrix, (1e3, 1e3), COLOR, spread=spread))
        check_radiance(Measurement(scene.done(), integrator, samples=4), np.array(ALBEDO) * COLOR, within=0.03)


def test_lamps_cast_no_shadow(integrator: str) -> None:
    """A point light behind an area light and a ball."""
    scene = plate().lamp(d.PointLight("point", (0, 0, 4), COLOR))
    scene.lamp(d.AreaLight("area", frame((0, 0, 2), (0, 0, 9)), (1, 1), COLOR))  # shines away from the plate
    ball = d.PointLight("ball", (0, 0, 3), grey(1e-9), radius=0.3)
    check_radiance(Measurement(scene.lamp(ball).done(), integrator), FLUX / 16, within=0.05, rounding=1e-5)


# ---- Environment ---------------------------------------------------------------------------------------------------


def image(height: int = 4, width: int = 8) -> NDArray[np.float32]:
    return (0.5 + np.random.default_rng(7).random((height, width, 3))).astype(np.float32)


TURN = frame((0, 0, 0), (0.5, -0.7, 0.9))


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize(("row", "column"), [(0, 0), (0, 5), (1, 3), (1, 4), (2, 6), (3, 1), (3, 7)])
def test_image_orientation(integrator: str, row: int, column: int, turned: bool) -> None:
    """Centre along +y, z up, +x to the right of it: seen in the direction of a texel's centre."""
    pixels = image()
    v, u = np.pi * (row + 0.5) / 4, 2 * np.pi * ((column + 0.5) / 8 - 0.5)
    direction = np.array([np.sin(v) * np.sin(u), np.sin(v) * np.cos(u), np.cos(v)])
    to_world = TURN if turned else np.eye(4)
    scene = Builder(
        radiometer((0, 0, 0), to_world[:3, :3] @ direction),
        environment=d.Environment(grey(2), pixels, to_world),
    )
    # The picture bends at a texel's centre, where it is looked at: over the view by 1e-4 of the difference to the next.
    expected = 2 * pixels[row, column].astype(float)
    check_radiance(Measurement(scene.done(), integrator), expected, within=EXACT, rounding=2e-4)


@pytest.mark.parametrize("turned", [False, True])
def test_image_irradiance(integrator: str, turned: bool) -> None:
    pixels = image()
    pixels[1, 3] = 40  # a small bright patch
    to_world = TURN if turned else np.eye(4)
    scene = plate(environment=d.Environment(grey(1), pixels, to_world))
    expected = np.array(ALBEDO) / np.pi * exact.environment_irradiance(pixels.astype(float), to_world)
    check_radiance(Measurement(scene.done(), integrator, samples=4), expected, within=0.02, rounding=1e-4)


def test_constant_environment(integrator: str) -> None:
    scene = plate(environment=d.Environment(COLOR))
    check_radiance(Measurement(scene.done(), integrator), np.array(ALBEDO) * COLOR, within=0.01)


def test_all_lights_together(integrator: str) -> None:
    """Light adds up."""
    scene = plate(environment=sky(0.1))
    scene.sphere((8, 0, 6), 1, d.Light(WHITE)).mesh(quad((-4, 0, 5), (1, 0, 0), (0, 1, 0)), d.Light(grey(0.3)))
    scene.lamp(d.PointLight("point", (0, 3, 4), WHITE)).lamp(d.SunLight("sun", (0, -1, -1), grey(0.05), 0))
    ways = [np.array([8, 0, 6.0]), np.array([0, 3, 4.0])]
    dark_sky = exact.sphere_irradiance(0.1, np.arccos(0.6))
    window = exact.polygon_irradiance([(-5, -1, 5), (-3, -1, 5), (-3, 1, 5), (-5, 1, 5)])
    total = 0.1 * (np.pi - dark_sky - window) + dark_sky + 0.3 * window
    total += ways[1][2] / np.linalg.norm(ways[1]) ** 3 + 0.05 / np.sqrt(2)
    check_radiance(Measurement(scene.done(), integrator, samples=4), np.array(ALBEDO) / np.pi * total, within=0.02)
