# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces in uniform light, or in their own: what they must give back is their albedo."""

from functools import partial

import numpy as np

from addon.scene import description as d
from tests.check import formulas
from tests.check.case import Case, Limit, picture
from tests.render import closed_forms as exact
from tests.render.build import WHITE, Builder, box, camera, floor, grey, octahedron, quad, radiometer, sky

UNIT = 2.0**-24
TOO_THIN = Limit(
    "a ray leaves a surface by 2^-20 of its distance or so, further than to the other face: once within, it ends there",
    0.6,
)
FAR = (7.0, -11.0, 5.0)


def ball(material: d.Material, shape: str = "sphere") -> d.SceneDescription:
    scene = Builder(camera(FAR, (0, 0, 0), 5), environment=sky())
    if shape == "sphere":
        return scene.sphere((0, 0, 0), 2, material).done()
    return scene.mesh(octahedron((0, 0, 0), 3), material).done()


def nested() -> d.SceneDescription:
    scene = Builder(camera(FAR, (0, 0, 0), 25), environment=sky())
    scene.sphere((0, 0, 0), 3, d.Glass(1.5)).sphere((0.5, 0, 0), 1.5, d.Glass(10)).sphere(
        (0.5, 0, 0.5), 0.7, d.Glass(1.0001)
    )
    return scene.sphere((0.5, 0, 0.5), 0.3, d.Lambert(WHITE)).done()


def in_nested_glass() -> d.SceneDescription:
    scene = Builder(camera((0.1, 0.2, 0.3), FAR, 100), environment=sky())
    scene.sphere((0, 0, 0), 3, d.Glass(1.5))
    return scene.sphere((0, 0, 0), 1, d.Glass(2.4)).done()


def facing_plates(gap: float) -> d.SceneDescription:
    """Seen from between them."""
    scene = Builder(camera((0.1, 0.2, 0.3 * gap), (0.3, 0.2, 0), 40), environment=sky())
    return scene.mesh(floor(0, 1), d.Lambert(WHITE)).mesh(floor(gap, 1), d.Lambert(WHITE)).done()


def corridor(bounces: int, material: d.Material) -> d.SceneDescription:
    """Two mirrors 2 apart, the ray at 45 degrees; one channel loses nothing, so no path ends early."""
    end = 2.0 * bounces
    scene = Builder(radiometer((0, 0, 0), (1, 1, 0)))
    for x in (1, -1):
        scene.mesh(quad((x, end / 2, 0), (0, end, 0), (0, 0, 2)), material)
    return scene.mesh(quad((0, end, 0), (1, 0, 0), (0, 0, 2)), d.Light(WHITE)).done()


def shining_box(albedo: float) -> d.SceneDescription:
    scene = Builder(camera((0.2, 0.1, 0.3), (2, 1, 0), 80), 8, 8)
    return scene.mesh(box((-2, -2, -1), (2, 2, 3)), d.Lambert(grey(albedo), grey(1 - albedo))).done()


def integrating_sphere(ratio: float) -> d.SceneDescription:
    """Looks at the wall past the ball of light."""
    scene = Builder(camera((0, 0.5, 0), (0.3, 1, 0.2), 40), 8, 8)
    return (
        scene.sphere((0, 0, 0), 1, d.Lambert(grey(0.999))).sphere((0, 0, 0), ratio, d.Light(grey(1 / ratio**2))).done()
    )


def metal(alpha: float, mu: float) -> d.SceneDescription:
    view = radiometer((10 * np.sqrt(1 - mu**2), 0, 10 * mu), (0, 0, 0))
    return Builder(view, environment=sky()).mesh(floor(half=20), d.Conductor(alpha, f0=WHITE)).done()


def slab(degrees: float, thickness: float, distance: float) -> d.SceneDescription:
    """A light behind (red), one before (green)."""
    a = np.radians(degrees)
    way = np.array([0, np.sin(a), -np.cos(a)])
    scene = Builder(radiometer(-distance * way, (0, 0, 0)))
    half = 30 if thickness == 1 else 1
    scene.mesh(box((-half, -0.9 * half, -thickness), (1.1 * half, half, 0)), d.Glass(1.5))
    scene.mesh(floor(-1e3, 1e6), d.Light((1, 0, 1)))
    return scene.mesh(floor(1e3, 1e6), d.Light((0, 1, 1))).done()


def cases() -> list[Case]:
    result = [
        picture("white sphere", lambda: ball(d.Lambert(WHITE)), 1),
        picture("white mesh", lambda: ball(d.Lambert(WHITE), "mesh"), 1),
        picture("mirror sphere", lambda: ball(d.Mirror((1, 0.6, 0.2))), (1, 0.6, 0.2)),
    ]
    for ior in (1.0001, 1.5, 3, 10, 0.5):
        for shape in ("sphere", "mesh"):
            result.append(picture(f"glass {shape} of index {ior:g}", partial(ball, d.Glass(ior), shape), 1))
    result += [
        picture("nested glass, 1.5 around 10 around 1.0001", nested, 1, within=0.03, quick=True),
        picture("camera in nested glass of index 2.4", in_nested_glass, 1, within=0.03, quick=True),
        picture("white plates face to face, 0.1 of their size apart", lambda: facing_plates(0.2), 1, quick=True),
        picture("white plates face to face, 0.01 of their size apart", lambda: facing_plates(0.02), 1),
        picture(
            "mirror corridor, 20 bounces",
            lambda: corridor(20, d.Mirror((1, 0.9, 0.5))),
            np.array([1, 0.9, 0.5]) ** 20,
            within=0,
            rounding=(64 + 4 * 20) * UNIT,
        ),
        picture(
            "mirror corridor, 200 bounces",
            lambda: corridor(200, d.Mirror((1, 0.99, 0.9))),
            np.array([1, 0.99, 0.9]) ** 200,
            within=0,
            rounding=(64 + 4 * 200) * UNIT,
            quick=True,
        ),
        picture(
            "mirror corridor, 200 bounces, by roulette",
            lambda: corridor(200, d.Mirror(grey(0.99))),
            0.99**200,
            within=0.05,
        ),
        picture(
            "mirror corridor, 320 bounces, the last of them by roulette",  # long chains of mirrors are thinned
            lambda: corridor(320, d.Mirror((1, 0.999, 0.99))),
            np.array([1, 0.999, 0.99]) ** 320,
            within=0.1,
        ),
        picture("box of albedo 0.9 that shines", lambda: shining_box(0.9), 1, within=0.05, quick=True),
        picture("box of albedo 0.999 that shines", lambda: shining_box(0.999), 1, within=0.1),
    ]
    for ratio in (0.3, 0.03):
        result.append(
            picture(
                f"integrating sphere of albedo 0.999, a light {ratio:g} as wide in it",
                partial(integrating_sphere, ratio),
                formulas.integrating_sphere(0.999, ratio) / ratio**2,
                within=0.05,
            )
        )
    for alpha in (1e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.5, 1):
        for mu in (1, 0.5, 0.1, 0.01, 0.001):
            smooth = alpha < 1e-4
            expected = 1.0 if smooth else exact.ggx_albedo(mu, alpha)
            result.append(
                picture(
                    f"metal of alpha {alpha:g} at mu {mu:g}",
                    partial(metal, alpha, mu),
                    expected,
                    within=0 if smooth else 0.01,
                    # The view is 1e-4 wide: at grazing incidence mu itself varies by 1e-4/mu, evenly to first order.
                    rounding=2e-5 + (1e-4 / mu) ** 2,
                    quick=alpha in (1e-4, 1e-3) and mu in (0.5, 0.01),
                )
            )
    for degrees in (0, 45, 80, 89):
        for thickness, distance in ((1.0, 5.0), (1e-4, 10.0), (1e-6, 10.0)):
            r = exact.fresnel(float(np.cos(np.radians(degrees))), 1.5)
            result.append(
                picture(
                    f"glass slab {thickness:g} thin at {degrees:g} degrees",
                    partial(slab, degrees, thickness, distance),
                    [formulas.slab_transmission(r), 1 - formulas.slab_transmission(r), 1],
                    samples=4,
                    within=0.03,
                    rounding=2e-3 if degrees > 85 else 1e-5,  # over the width of the view
                    quick=thickness < 1 and degrees in (0, 80),
                    limit=TOO_THIN if thickness < 1e-5 else None,
                )
            )
    return result
