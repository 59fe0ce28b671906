# SPDX-License-Identifier: GPL-3.0-or-later
"""Fog: optical depths from 1e-8 to 1e4, every order of scattering, coefficients that differ by thousands."""

from functools import partial

import numpy as np
from numpy.typing import ArrayLike, NDArray

from addon.scene import description as d
from tests.check import formulas
from tests.check.case import Case, Estimate, Limit, picture
from tests.render import closed_forms as exact
from tests.render.build import BLACK, WHITE, Builder, box, camera, grey, octahedron, quad, radiometer
from tests.render.statistics import MOST_SEEDS, ROUNDING, Clock, Measurement, Pictures, strata

ALONG = np.array([0.0, 1.0, 0.0])
LEAST = 2.0**-149
"""The least float32 above 0."""
FLIES_PAST = Limit("noise: its free flights seldom end near the light", np.inf, ("baseline",))


def light_through(medium: d.Medium, radiance: float = 1) -> d.SceneDescription:
    """A ball of light, its surface at 10."""
    scene = Builder(radiometer((0, 0, 0), ALONG), medium=medium)
    return scene.sphere((0, 12, 0), 2, d.Light(grey(radiance))).done()


def furnace(sigma_s: d.Rgb, g: float = 0, objects: bool = False, size: int = 16) -> d.SceneDescription:
    """Within a ball of light of radius 2, the camera at most three mean free paths from its wall."""
    from_wall = min(3 / max(sigma_s), 1.5)
    scene = Builder(camera((0, from_wall - 2, 0), (0, 2, 0), 80), size, size, medium=d.Medium(BLACK, sigma_s, g))
    scene.sphere((0, 0, 0), 2, d.Light(WHITE))
    if objects:
        scene.sphere((0, from_wall - 1, 0), 0.5, d.Lambert(WHITE)).sphere((0.9, 0, 0.2), 0.3, d.Mirror(WHITE))
        scene.mesh(octahedron((-0.9, 0.2, 0), 0.4), d.Mix(0.5, d.Lambert(WHITE), d.Mirror(WHITE)))
        scene.sphere((0, 0.3, -1), 0.3, d.Glass(1.5))
    return scene.done()


def furnace_with_objects(sigma: float, size: int) -> d.SceneDescription:
    """The same with white objects a mean free path before the camera and as large, so that none is out of sight."""
    from_wall, unit = min(3 / sigma, 1.5), min(1 / sigma, 0.7)
    eye = np.array([0, from_wall - 2, 0])
    scene = Builder(camera(eye, (0, 2, 0), 80), size, size, medium=d.Medium(BLACK, grey(sigma)))
    scene.sphere((0, 0, 0), 2, d.Light(WHITE)).sphere(
        eye + unit * np.array([0.5, 1.2, 0]), 0.5 * unit, d.Lambert(WHITE)
    )
    scene.sphere(eye + unit * np.array([-0.5, 1.2, 0.3]), 0.4 * unit, d.Mirror(WHITE))
    scene.sphere(eye + unit * np.array([0, 1.2, -0.8]), 0.4 * unit, d.Glass(1.5))
    mix = d.Mix(0.5, d.Lambert(WHITE), d.Conductor(1e-5, f0=WHITE))
    return scene.mesh(octahedron(eye + unit * np.array([0.2, 1.2, 1]), 0.4 * unit), mix).done()


def shining_box() -> d.SceneDescription:
    """Walls of albedo 0.9 around white fog: nine tenths of the light was thrown there by a wall."""
    scene = Builder(camera((0.2, 0.1, 0.3), (2, 1, 0), 80), 8, 8, medium=d.Medium(BLACK, grey(0.4)))
    return scene.mesh(box((-2, -2, -1), (2, 2, 3)), d.Lambert(grey(0.9), grey(0.1))).done()


def over_metal(alpha: float) -> d.SceneDescription:
    """White fog over a plate of metal that reflects all, in a ball of light: half of the fog's light comes from it.
    Seen in a mirror, where light that smooth metal throws is met by paths alone."""
    scene = Builder(camera((0, 1, 0.5), (0, 2, 0.5), 50), medium=d.Medium(BLACK, grey(0.5)))
    scene.sphere((0, 0, 0), 2, d.Light(WHITE)).mesh(quad((0, 1.1, 0.5), (0.1, 0, 0), (0, 0, 0.1)), d.Mirror(WHITE))
    return scene.mesh(quad((0, 0, -0.3), (2.5, 0, 0), (0, 2.5, 0)), d.Conductor(alpha, f0=WHITE)).done()


def beside_ray(medium: d.Medium, light: d.PointLight | tuple[float, float]) -> d.SceneDescription:
    """A light beside the ray: a point, or a sphere of (radius, radiance) at (0.5, 1.5, 0)."""
    scene = Builder(radiometer((0, 0, 0), ALONG), medium=medium)
    if isinstance(light, d.PointLight):
        return scene.lamp(light).done()
    return scene.sphere((0.5, 1.5, 0), light[0], d.Light(grey(light[1]))).done()


BIG = (1.5, (1.6, 3.0, 0.0))
"""Radius and place of a ball of light that fills much of what the fog beside it sees."""
WALL = 10.0
"""Where the ray ends."""


def thin_before_wall(sigma: float) -> d.SceneDescription:
    scene = Builder(radiometer((0, 0, 0), ALONG), medium=d.Medium(BLACK, grey(sigma)))
    scene.mesh(quad((0, WALL, 0), (0, 0, 1), (1, 0, 0)), d.Lambert(BLACK))
    return scene.sphere(BIG[1], BIG[0], d.Light(WHITE)).done()


def slab(c: float, depth: float | None, mu: float, through: bool = False) -> d.SceneDescription:
    """A slab of fog of sigma_t 1 between two vast boxes of glass of index 1 (fog fills all space outside glass), or a
    half space; a sheet of light in the upper box close to it. By reciprocity a camera beneath the sheet sees the albedo
    for its own direction, one in the lower box the transmittance."""
    far, height, eye = 1e4, 0.02, 0.01
    slope = np.sqrt(1 - mu**2) / mu
    top = np.array([0, -eye * slope, eye])
    view = radiometer(top, (0, 0, 0))
    if through:
        assert depth is not None
        bottom = np.array([0, 0, -depth])
        view = radiometer(bottom - top, bottom)
    scene = Builder(view, 8, 8, medium=d.Medium(grey(1 - c), grey(c)))
    scene.mesh(box((-far, -0.9 * far, 0), (1.1 * far, far, 1)), d.Glass(1))
    if depth is not None:
        scene.mesh(box((-far, -0.9 * far, -depth - 1), (1.1 * far, far, -depth)), d.Glass(1))
        # What is let through must not come back from the fog below.
        scene.mesh(quad((0.05 * far, 0, -depth - 0.5), (far, 0, 0), (0, far, 0)), d.Lambert(BLACK))
    return scene.mesh(quad((0.1 * far, 0, height), (far, 0, 0), (0, far, 0)), d.Light(WHITE)).done()


def fluence(c: float, r: float, integrator: str, clock: Clock) -> Estimate:
    """At the distance r from a point of unit power, sigma_t 1: the light that comes straight, and of what is scattered
    2 pi int L(t) sin(t) dt, t from the light. Eight angles, one in each stratum, have their lights in one scene."""
    n, view = 8, radiometer((0, 0, 0), ALONG)

    def estimate(seed: int) -> float:
        scene = Builder(view, 4, 4, medium=d.Medium(grey(1 - c), grey(c)))
        for u in strata(np.random.default_rng(seed), n):
            theta = np.pi * u
            place = r * np.array([np.sin(theta), np.cos(theta), 0])
            scene.lamp(d.PointLight("point", tuple(place), grey(np.pi / (2 * n) * np.sin(theta))))
        scattered = Pictures(Measurement(scene.done(), integrator, samples=1), clock)(seed).mean()
        return float(np.exp(-r) / (4 * np.pi * r * r) + scattered)

    return estimate


def coloured_fluence(c: float, sigma: d.Rgb, r: float, integrator: str, clock: Clock) -> Estimate:
    """At the distance r from a point of unit power, of what is scattered alone: fog of an extinction of its own in each
    channel, all orders, as in `fluence`."""
    n, view = 8, radiometer((0, 0, 0), ALONG)
    red, green, blue = sigma
    medium = d.Medium(((1 - c) * red, (1 - c) * green, (1 - c) * blue), (c * red, c * green, c * blue))

    def estimate(seed: int) -> ArrayLike:
        scene = Builder(view, 4, 4, medium=medium)
        for u in strata(np.random.default_rng(seed), n):
            theta = np.pi * u
            place = r * np.array([np.sin(theta), np.cos(theta), 0])
            scene.lamp(d.PointLight("point", tuple(place), grey(np.pi / (2 * n) * np.sin(theta))))
        picture = Pictures(Measurement(scene.done(), integrator, samples=1), clock)(seed)
        mean: NDArray[np.float64] = picture.mean(axis=(0, 1))
        return mean

    return estimate


THREE_DECADES = (0.003, 0.1, 3.0)


def scattered_fluence(c: float, sigma: d.Rgb, r: float) -> NDArray[np.float64]:
    """What `coloured_fluence` expects: lengths are in mean free paths, fluences per square of one."""
    scattered = [
        s * s * (exact.infinite_fluence(c, s * r) - np.exp(-s * r) / (4 * np.pi * (s * r) ** 2)) for s in sigma
    ]
    return np.array(scattered)


def dark_room(integrator: str, clock: Clock) -> Estimate:
    """1 and the light in a sealed room in fog beside lights of three colours, (3) relative to what scatters once
    without the room."""
    scene = Builder(radiometer((0, 0, 0), ALONG), medium=d.Medium(grey(0.02), grey(0.1)))
    scene.mesh(box((-2, -2, -2), (2, 2, 2)), d.Lambert(grey(0.5)))
    lit = np.zeros(3)
    for k in range(6):
        place = (3.5 * np.sin(k), 3.5 * np.cos(k), 0.8 * k - 2)
        color = np.roll([1.0, 0.1, 0.01], k)
        scene.sphere(place, 0.5, d.Light(tuple(color)))
        lit += color * exact.sphere_airlight(0.12, 0.1, 0, 0.5, place, ALONG, 2)
    pictures = Pictures(Measurement(scene.done(), integrator, samples=4), clock)

    def estimate(seed: int) -> ArrayLike:
        mean: NDArray[np.float64] = 1 + pictures(seed).mean(axis=(0, 1)) / lit
        return mean

    return estimate


def absorption() -> list[Case]:
    result = []
    for depth in (1e-8, 1e-4, 1, 20, 50, 85, 100):
        medium = d.Medium(grey(depth / 10), BLACK)
        # The depth is off by 2^-23 of itself, twice; the result by half the least float.
        rounding = ROUNDING + 2 * depth * 2.0**-23 + 0.5 * LEAST / np.exp(-depth)
        result.append(
            picture(
                f"absorption of depth {depth:g}",
                partial(light_through, medium),
                np.exp(-depth),
                within=0,
                rounding=rounding,
                quick=depth >= 50,
            )
        )
    underflow = Limit("transmittance is a float32: below 1e-38 it has few digits, below 1e-45 it is 0", 1.0)
    for depth in (98, 120):
        result.append(
            picture(
                f"absorption of depth {depth}, seen through by a light of 1e30",
                partial(light_through, d.Medium(grey(depth / 10), BLACK), 1e30),
                np.exp(-depth) * 1e30,
                within=0,
                rounding=ROUNDING + 2 * depth * 2.0**-23,
                limit=underflow,
            )
        )
    depths = np.array([0.01, 1, 10])
    result.append(
        picture(
            "absorption over three decades of colour",
            lambda: light_through(d.Medium(tuple(depths / 10), BLACK)),
            np.exp(-depths),
            within=0,
            rounding=ROUNDING + 20 * 2.0**-23,
        )
    )
    return result


def scattered_once() -> list[Case]:
    result = []
    height, foot = 1.0, 3.0
    point = d.PointLight("point", (height, foot, 0), WHITE)
    for sigma in (1e-8, 1e-4, 0.1, 3):
        result.append(
            picture(
                f"scattered once, sigma {sigma:g}",
                partial(beside_ray, d.Medium(BLACK, grey(sigma)), point),
                formulas.point_airlight_exact(sigma, sigma, 0, height, foot, np.inf),
                max_scatter=1,
                within=0.03,
                rounding=1e-5,
                quick=sigma == 1e-8,
                most_seeds=MOST_SEEDS if sigma > 1e-3 else 256,
                limit=FLIES_PAST if not 1e-3 < sigma < 1 else None,
            )
        )
    for g in (-0.99, -0.7, 0.7, 0.99):
        result.append(
            picture(
                f"scattered once, g {g:g}",
                partial(beside_ray, d.Medium(grey(0.02), grey(0.08), g), point),
                formulas.point_airlight_exact(0.1, 0.08, g, height, foot, np.inf),
                max_scatter=1,
                within=0.05,
                rounding=1e-5,
                quick=g == 0.99,
            )
        )
    for radius in (1e-1, 1e-3, 1e-5):
        result.append(
            picture(
                f"scattered once in dense fog, light of radius {radius:g}",
                partial(beside_ray, d.Medium(grey(0.5), grey(2.5)), (radius, 1 / radius**2)),
                exact.sphere_airlight(3, 2.5, 0, radius, (0.5, 1.5, 0), ALONG, np.inf) / radius**2,
                max_scatter=1,
                within=0.03,
                rounding=1e-5,
                quick=radius == 1e-3,
            )
        )
    for sigma in (1e-8, 1e-9):
        result.append(
            picture(
                f"scattered once before a wall, depth {sigma * WALL:g}, a light that fills much of the view",
                partial(thin_before_wall, sigma),
                exact.sphere_airlight(sigma, sigma, 0, *BIG, ALONG, WALL),
                max_scatter=1,
                within=0.02,
                quick=sigma == 1e-8,
                most_seeds=MOST_SEEDS,
                integrators=("path",),  # free flights of the other one do not end within 1e7 samples
            )
        )
    for power in (-30, 30):
        result.append(
            picture(
                f"scattered once, light of radiance 1e{power}",
                partial(beside_ray, d.Medium(grey(0.02), grey(0.08)), (0.3, 10.0**power)),
                exact.sphere_airlight(0.1, 0.08, 0, 0.3, (0.5, 1.5, 0), ALONG, np.inf) * 10.0**power,
                max_scatter=1,
                within=0.03,
                rounding=1e-5,
            )
        )
    sigma_a, sigma_s = (0.0, 0.3, 0.2), (0.1, 0.0, 3.0)
    result.append(
        picture(
            "scattered once, a channel without scattering, one without absorption",
            lambda: beside_ray(d.Medium(sigma_a, sigma_s, 0.3), (0.3, 1)),
            [
                exact.sphere_airlight(a + s, s, 0.3, 0.3, (0.5, 1.5, 0), ALONG, np.inf) if s > 0 else 0
                for a, s in zip(sigma_a, sigma_s, strict=True)
            ],
            max_scatter=1,
            within=0.03,
            rounding=1e-5,
        )
    )
    return result


def every_order() -> list[Case]:
    result = []
    for c, r in ((0.5, 1.0), (0.9, 0.1), (0.9, 3.0), (0.99, 1.0), (0.999, 1.0), (1.0, 1.0)):
        expected = formulas.endless_fluence(r) if c == 1 else exact.infinite_fluence(c, r)
        result.append(
            Case(
                f"endless fog of albedo {c:g}, fluence at {r:g}",
                expected,
                partial(fluence, c, r),
                within=0.1 if c > 0.99 else 0.05,
                rounding=1e-5,
                quick=c == 0.9 and r < 1,
                limit=FLIES_PAST if c == 0.5 or c > 0.9 or r > 1 else None,
            )
        )
    result.append(
        Case(
            "endless fog of albedo 0.9, three decades of colour, fluence at 1 of what is scattered",
            scattered_fluence(0.9, THREE_DECADES, 1),
            partial(coloured_fluence, 0.9, THREE_DECADES, 1),
            within=0.05,
            rounding=1e-5,
            limit=FLIES_PAST,
        )
    )
    for c, mu in ((0.5, 1.0), (0.9, 0.1), (0.99, 0.5)):
        result.append(
            picture(
                f"half space of albedo {c:g}, plane albedo at {mu:g}",
                partial(slab, c, None, mu),
                exact.half_space_albedo(c, mu),
                within=0.05,
            )
        )
    for c, depth, mu in ((0.9, 1.0, 0.5), (1.0, 10.0, 1.0)):
        result.append(
            picture(
                f"slab of depth {depth:g} and albedo {c:g}, sent back at {mu:g}",
                partial(slab, c, depth, mu),
                formulas.slab_albedo(c, depth, mu),
                within=0.05,
            )
        )
        result.append(
            picture(
                f"slab of depth {depth:g} and albedo {c:g}, let through at {mu:g}",
                partial(slab, c, depth, mu, through=True),
                formulas.slab_transmittance(c, depth, mu),
                within=0.05,
            )
        )
    return result


def white_furnaces() -> list[Case]:
    result = []
    for depth in (1e-4, 1, 30, 100, 1e3, 1e4):
        thick = depth >= 1e3
        result.append(
            picture(
                f"furnace of white fog, {depth:g} deep",
                partial(furnace, grey(depth / 4), size=8 if 1e-3 < depth < 1e3 else 4),
                1,
                # At 1e-4 `baseline` scatters one path in 16 000, and that is what the rest of them lack.
                samples=1024 if depth < 1e-3 else 1,
                within=0.1,
                quick=depth == 1,
                most_seeds=256 if thick else MOST_SEEDS,
            )
        )
    for g in (-0.99, 0.99):
        result.append(picture(f"furnace of white fog, g {g:g}", partial(furnace, grey(2), g), 1, within=0.05))
    result += [
        picture("furnace of white fog with objects", lambda: furnace(grey(1), 0, True), 1, within=0.03, quick=True),
        picture("furnace of white fog between walls of albedo 0.9 that shine", shining_box, 1, within=0.05),
        picture(
            "furnace of white fog over smooth metal, in a mirror",
            lambda: over_metal(1e-3),
            1,
            within=0.0125,
            rounding=2 * formulas.metal_loss(1e-3),  # few paths meet it twice
        ),
        picture("furnace of white fog, 30 deep, with objects", lambda: furnace(grey(7.5), 0, True, 8), 1, within=0.1),
        picture("furnace of white fog, three decades of colour", lambda: furnace((0.002, 0.06, 2)), 1, within=0.05),
        picture(
            "furnace of fog that one channel lacks", lambda: furnace((2, 0, 0.3), size=8), 1, within=0.05, quick=True
        ),
        Case("a sealed room in fog beside lights of three colours: noise about 0", np.ones(3), dark_room, within=0.05),
    ]
    for depth in (1e-4, 100, 1e3, 1e4):
        thick = depth >= 1e3
        result.append(
            picture(
                f"furnace of white fog, {depth:g} deep, objects a mean free path from the camera",
                partial(furnace_with_objects, depth / 4, 4 if thick else 8),
                1,
                within=0.1,
                most_seeds=256 if thick else MOST_SEEDS,
            )
        )
    return result


def cases() -> list[Case]:
    return absorption() + scattered_once() + every_order() + white_furnaces()
