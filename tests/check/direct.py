# SPDX-License-Identifier: GPL-3.0-or-later
"""Direct light: from lights of a millionth of a radian to lights as large as a planet."""

from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from addon.scene import description as d
from tests.check.case import Case, picture
from tests.render import closed_forms as exact
from tests.render.build import Builder, at, camera, floor, grey, quad, radiometer
from tests.render.statistics import ROUNDING

ALBEDO = (0.8, 0.5, 0.2)
FLUX = np.array(ALBEDO) / np.pi
"""Radiance of the plate per irradiance."""
UNIT = 2.0**-24


SPHERES = {
    # sine of the angular radius, angle of the centre from the normal
    "overhead": (0.5, 0.0),
    "oblique": (0.3, 0.7),
    "clipped, centre above the horizon": (0.5, 1.3),
    "clipped, centre below the horizon": (0.5, 1.8),
    "a sliver above the horizon": (0.2, 1.72),
    "wide and clipped": (0.9, 1.0),
    "almost all of the sky": (0.999, 0.0),
}


def plate(eye: ArrayLike, half: float = 1e-3) -> Builder:
    """A plate at z = 0, seen at the origin; so small that no light beneath its horizon is cut by it."""
    return Builder(radiometer(eye, (0, 0, 0))).mesh(floor(half=half), d.Lambert(ALBEDO))


def lit_by(theta: float, sine: float, distance: float = 10, radiance: float = 1) -> d.SceneDescription:
    """A sphere light of angular radius asin(sine), theta from the normal."""
    gap = min(distance * (1 - sine), 0.05)  # the eye is within it
    scene = plate((-0.4 * gap, -0.6 * gap, 0.4 * gap))
    return scene.sphere(distance * at(theta), distance * sine, d.Light(grey(radiance))).done()


def seen(sine: float, radius: float = 1.0) -> d.SceneDescription:
    """A sphere light before black, filling an eighth of the picture or so."""
    view = camera((0, 0, 0), (0, 1, 0), float(np.degrees(4 * sine)))
    return Builder(view).sphere((0, radius / sine, 0), radius, d.Light(grey(1))).done()


def share_seen(sine: float) -> float:
    """Of the square picture: the disk pi tan^2 over (2 tan)^2."""
    half = np.tan(2 * sine)
    return float(np.pi * sine**2 / (1 - sine**2) / (4 * half**2))


def many_lights(count: int = 1000) -> tuple[d.SceneDescription, NDArray[Any]]:
    """Lights of six decades of distance and as many of power, none before another."""
    rng = np.random.default_rng(11)
    theta = np.arccos(1 - (np.arange(count) + 0.5) / count * 0.95)
    azimuth = np.arange(count) * np.pi * (3 - np.sqrt(5))
    distance = 10 ** rng.uniform(0, 6, count)
    sine, radiance = 0.01, 10 ** rng.uniform(-3, 3, count)
    scene = plate((-0.02, -0.03, 0.02))
    for t, p, r, emitted in zip(theta, azimuth, distance, radiance, strict=True):
        scene.sphere(r * at(t, p), r * sine, d.Light(grey(emitted)))
    return scene.done(), FLUX * np.pi * sine**2 * (radiance * np.cos(theta)).sum()


def blinding() -> d.SceneDescription:
    """More lights than are sampled one by one; all but the large one are beneath the plate."""
    scene = plate((-0.02, -0.03, 0.02)).sphere((0, 0, 2e7), 1e7, d.Light(grey(1e30)))
    for k in range(20):
        scene.sphere((k - 10, 3, -5), 0.3, d.Light(grey(1e30)))
    return scene.done()


def inside(material: d.Material | None) -> d.SceneDescription:
    """A camera within a sphere that shines 1, with or without a plate in it."""
    scene = Builder(camera((0.3, 0.2, 0.1), (0.3, 1, 0.1), 60)).sphere((0, 0, 0), 2, d.Light(grey(1)))
    if material is not None:
        scene.mesh(quad((0, 1, 0), (5, 0, 0), (0, 0, 5)), material)
    return scene.done()


def near_touching(radius: float, gap: float) -> d.SceneDescription:
    """A ball of light just over the plate, straight above where the camera looks. The eye is within the gap."""
    eye = np.array([-0.3, -0.2, 0.1]) * gap
    scene = Builder(radiometer(eye, (0, 0, 0))).mesh(floor(half=min(1e-3, gap)), d.Lambert(ALBEDO))
    return scene.sphere((0, 0, radius + gap), radius, d.Light(grey(1))).done()


def lamp(light: d.Lamp, scale: float = 1) -> d.SceneDescription:
    return plate((0.3 * scale, -2 * scale, 0.7 * scale), half=2 * scale).lamp(light).done()


def area(side: float) -> d.SceneDescription:
    down = np.eye(4)
    down[:3, 3] = (0, 0, 3)
    return lamp(d.AreaLight("area", down, (side, side), grey(1 / side**2)))


def small_triangle(side: float) -> d.SceneDescription:
    scene = plate((0.3, -2, 0.7), half=2)
    return scene.mesh(quad((0, 0, 3), (side / 2, 0, 0), (0, side / 2, 0)), d.Light(grey(1 / side**2))).done()


def cases() -> list[Case]:
    result = []
    for what, (sine, theta) in SPHERES.items():
        result.append(
            picture(
                f"sphere light {what}",
                partial(lit_by, theta, sine),
                FLUX * exact.sphere_irradiance(sine, theta),
                within=0.05 if "sliver" in what else 0.02,
            )
        )
    result.append(
        picture("sphere light below the horizon", lambda: lit_by(1.9, 0.3), 0, samples=8, within=0, quick=True)
    )
    for sine in (1e-2, 1e-3, 1e-4, 1e-5, 1e-6):
        expected = FLUX * np.pi * sine**2 * np.cos(0.5)
        result.append(picture(f"sphere light of R/d {sine:g}", partial(lit_by, 0.5, sine), expected, quick=sine < 1e-3))
    for radius, gap in ((1.0, 1e-3), (1e3, 1e-3), (1e7, 1.0), (1e7, 1e-2)):
        expected = FLUX * np.pi / (1 + gap / radius) ** 2
        result.append(
            picture(
                f"sphere light of radius {radius:g}, {gap:g} above the plate",
                partial(near_touching, radius, gap),
                expected,
                quick=radius == 1e7,
            )
        )
    for power in (-30, -20, -10, 10, 20, 30):
        expected = FLUX * exact.sphere_irradiance(0.3, 0.7) * 10.0**power
        result.append(
            picture(
                f"sphere light of radiance 1e{power}",
                partial(lit_by, 0.7, 0.3, radiance=10.0**power),
                expected,
                quick=abs(power) == 30,
            )
        )
    scene, total = many_lights()
    result.append(picture("1000 lights, six decades of distance and power", lambda: scene, total, within=0.05))
    result += [
        picture(
            "sphere lights of radiance 1e30, one of radius 1e7 and twenty others",
            blinding,
            FLUX * 1e30 * np.pi * 0.25,
            within=0.05,
        ),
        picture(
            "lamp of radius 1e-25",
            lambda: lamp(d.PointLight("tiny", tuple(3 * at(0.6)), grey(9), radius=1e-25)),
            FLUX * np.cos(0.6),
            rounding=ROUNDING + 1e-6,
        ),
    ]
    result.append(picture("camera within a light", lambda: inside(None), 1, within=0, quick=True))
    result.append(picture("plate within a light", lambda: inside(d.Lambert(ALBEDO)), ALBEDO))
    for sine in (1e-2, 1e-4, 1e-6):
        result.append(
            picture(
                f"light seen at {1 / sine:g} radii",
                partial(seen, sine),
                share_seen(sine),
                rounding=4 * UNIT / sine + ROUNDING if sine > 1e-6 else 1e-2,  # directions are float32
                quick=sine == 1e-4,
            )
        )
    for distance in (1e-6, 1, 1e7):
        point = d.PointLight("point", tuple(distance * at(0.6)), grey(distance**2))
        result.append(
            picture(
                f"point light at {distance:g}",
                partial(lamp, point, min(distance, 1.0)),
                FLUX * np.cos(0.6),
                rounding=ROUNDING + 1e-6,  # the width of the view
            )
        )
    for side in (1e-2, 1e-4, 1e-6):
        result.append(
            picture(f"area lamp of side {side:g}", partial(area, side), FLUX / 9, rounding=side**2 + ROUNDING)
        )
        result.append(
            picture(
                f"mesh light of side {side:g}",
                partial(small_triangle, side),
                FLUX / 9,
                rounding=side**2 + ROUNDING,
            )
        )
    for angle in (1e-6, 1e-3, 0.5, 90):
        sun = d.SunLight("sun", (0, 0.3, -1), grey(1), angle)
        # By chance one path in 13 000 meets the sun of half a degree, for 8e-5 of its light: enough paths to see that.
        samples = 64 if angle == 0.5 else 1
        result.append(
            picture(f"sun of {angle:g} degrees", partial(lamp, sun), FLUX / np.hypot(1, 0.3), samples=samples)
        )
    return result
