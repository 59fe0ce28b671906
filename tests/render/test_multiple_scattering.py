# SPDX-License-Identifier: GPL-3.0-or-later
"""All orders of scattering: problems of transport theory that are solved to ten digits."""

import numpy as np
import pytest

from addon.scene import description as d
from tests.render import closed_forms as exact
from tests.render.build import WHITE, Builder, box, grey, quad, radiometer
from tests.render.statistics import INTEGRATORS, Measurement, Pictures, check_mean, check_radiance, strata

pytestmark = pytest.mark.parametrize("integrator", INTEGRATORS)


@pytest.mark.parametrize("mu", [1, 0.5, 0.1])
@pytest.mark.parametrize("c", [0.5, 0.9])
def test_half_space(integrator: str, c: float, mu: float) -> None:
    """The plane albedo of a half space of fog.

    Fog fills all space outside glass, so the other half is a vast box of glass of index 1, and in it, close to the
    boundary, a sheet that shines. By reciprocity the camera beneath the sheet sees the albedo for its own direction.
    """
    far = 1e4
    height, eye = 0.02, 0.01
    origin = np.array([0, -eye * np.sqrt(1 - mu**2) / mu, eye])
    scene = Builder(radiometer(origin, (0, 0, 0)), medium=d.Medium(grey(1 - c), grey(c)))
    scene.mesh(box((-far, -0.9 * far, 0), (1.1 * far, far, 1)), d.Glass(1))
    scene.mesh(quad((0.1 * far, 0, height), (far, 0, 0), (0, far, 0)), d.Light(WHITE))
    # What leaves below the sheet at an angle that passes its end: (height / far)^2.
    expected = exact.half_space_albedo(c, mu)
    check_radiance(Measurement(scene.done(), integrator, samples=8), expected, within=0.03)


def fluence(integrator: str, c: float, r: float, seed: int) -> float:
    """Fluence at the distance r from a point of unit power, one random estimate of it by radiometers.

    It is the uncollided light plus 2 pi int L(theta) sin(theta) dtheta, theta from the light; L sin(theta) is bounded.
    One angle is drawn in each of eight strata, with its own camera.
    """
    total = np.exp(-r) / (4 * np.pi * r * r)
    n = 8
    for k, u in enumerate(strata(np.random.default_rng(seed), n)):
        theta = np.pi * u
        light = r * np.array([np.sin(theta), np.cos(theta), 0])
        scene = Builder(radiometer((0, 0, 0), (0, 1, 0)), 4, 4, medium=d.Medium(grey(1 - c), grey(c)))
        scene.lamp(d.PointLight("point", tuple(light), grey(1 / (4 * np.pi))))
        # Something far away and small that is part of a scene, as every scene has.
        scene.sphere((0, -60, 0), 1e-3, d.Light(grey(1e-30)))
        picture = Pictures(Measurement(scene.done(), integrator, samples=4))(8 * seed + k)
        total += 2 * np.pi * np.pi / n * np.sin(theta) * picture.mean()
    return float(total)


@pytest.mark.parametrize(
    ("c", "r"), [(0.5, 1), (0.9, 0.3), *(pytest.param(0.9, r, marks=pytest.mark.full) for r in (1, 3))]
)
def test_infinite_medium(integrator: str, c: float, r: float) -> None:
    """Order after order into every direction: nothing but distances, phase and roulette."""
    check_mean(
        lambda seed: fluence(integrator, c, r, seed),
        exact.infinite_fluence(c, r),
        within=0.05,
        what=f"{integrator} albedo {c} at {r}",
    )
