# SPDX-License-Identifier: GPL-3.0-or-later
"""Light that wanders beneath surfaces: furnaces, the spherical albedo of a half-space, and slabs against an independent
walk."""

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from addon.scene import description as d
from tests.render.build import BLACK, WHITE, Array, Builder, box, camera, floor, grey, octahedron, radiometer, sky
from tests.render.closed_forms import spherical_albedo
from tests.render.statistics import Measurement, check_radiance

INTEGRATOR = "path"  # both have the same walk

ABOVE = (0.0, 0.0, 10.0)
MILK = d.Subsurface(WHITE, (0.5, 0.1, 0.02))


@pytest.mark.parametrize(
    ("shape", "milk"),
    [
        ("sphere", MILK),
        ("mesh", replace(MILK, entry="diffuse", anisotropy=0.7)),
        ("sphere", replace(MILK, model="fixed_radius", radius=grey(3.0), entry="both")),
        ("mesh", replace(MILK, radius=(0.3, 0.0, 1e-7))),
    ],
    ids=["refracted", "forward", "fixed radius", "nearly diffuse"],
)
def test_white_bodies_lose_no_light(shape: str, milk: d.Subsurface) -> None:
    scene = Builder(camera((7.0, -11.0, 5.0), (0, 0, 0), 8), environment=sky())
    if shape == "sphere":
        scene.sphere((0, 0, 0), 1, milk)
    else:
        scene.mesh(octahedron((0, 0, 0), 1, splits=2), milk, instances=np.diag([1.0, 1.5, 0.7, 1])[None])
    check_radiance(Measurement(scene.done(), INTEGRATOR), 1, within=0.03)


def single_scattering(albedo: float) -> float:
    """d'Eon's inversion of isotropic scattering."""
    s = 4.20863 * albedo - np.sqrt(9.59217 + 41.6808 * albedo + 17.7126 * albedo**2) + 4.09712
    return float(1 - s * s)


def test_a_half_space() -> None:
    """Under a uniform sky, entered by cosine."""
    albedo = (0.8, 0.6, 0.2)
    milk = d.Subsurface(albedo, (0.003, 0.001, 0.002), entry="diffuse")
    scene = Builder(radiometer(ABOVE, (0, 0, 0)), environment=sky()).mesh(box((-2, -2, -2), (2, 2, 0)), milk)
    expected = [spherical_albedo(single_scattering(a)) for a in albedo]
    check_radiance(Measurement(scene.done(), INTEGRATOR), expected, within=0.025)


@cache
def slab(alpha: float, depth: float) -> tuple[float, float]:
    """What a slab reflects and transmits of light that enters it by cosine: a walk in one dimension."""
    rng = np.random.default_rng(7)
    n = 400_000
    z: Array = np.zeros(n)
    cosine: Array = np.sqrt(rng.random(n))
    weight: Array = np.ones(n)
    reflected = transmitted = 0.0
    while weight.size:
        z = z + cosine * rng.exponential(size=z.size)
        reflected, transmitted = reflected + weight[z < 0].sum(), transmitted + weight[z > depth].sum()
        inside = (z >= 0) & (z <= depth)
        z, weight = z[inside], weight[inside] * alpha
        lives = rng.random(z.size) < np.minimum(1, weight / 0.1)
        z, weight = z[lives], np.maximum(weight[lives], 0.1)
        cosine = 2 * rng.random(z.size) - 1
    return reflected / n, transmitted / n


@pytest.mark.parametrize(
    ("behind", "depth", "radius"),
    [(True, 2.0, 1e-3), (True, 0.5, 2e-5), (False, 0.5, 2e-5)],
    ids=["from behind", "thin, from behind", "thin"],
)
def test_a_slab(behind: bool, depth: float, radius: float) -> None:
    """All channels at once, each with its own albedo, by walks that share their steps. The thin ones are 15 rounding
    errors thick, of which none may be missing."""
    albedo = (0.9, 0.7, 0.5)
    light: dict[str, Any] = {} if behind else {"environment": sky()}
    scene = Builder(radiometer(ABOVE, (0, 0, 0)), **light)
    scene.mesh(box((-1, -1, -radius * depth), (1, 1, 0)), d.Subsurface(albedo, grey(radius), entry="diffuse"))
    scene.mesh(floor(-0.01, 4), d.Light(WHITE) if behind else d.Lambert(BLACK))
    expected = [slab(single_scattering(a), depth)[int(behind)] for a in albedo]
    check_radiance(Measurement(scene.done(), INTEGRATOR), expected, within=0.025)


def test_no_radius_is_a_diffuse_surface() -> None:
    scene = Builder(radiometer(ABOVE, (0, 0, 0)), environment=sky())
    scene.mesh(box((-1, -1, -1), (1, 1, 0)), d.Subsurface((0.8, 0.5, 0.3), grey(0.0)))
    check_radiance(Measurement(scene.done(), INTEGRATOR), (0.8, 0.5, 0.3), within=0.01)
