# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a change has made the noise of a sample larger: needs no clock.

Where a change means to (a cheaper sample that is noisier), or has made it smaller, commit the figures that

    python -m tests.render.test_error_variance

prints; GLIMMER_LIB_DIR names the folder of the library.
"""

import sys

import numpy as np
import pytest
from scipy import stats

from addon.scene import description as d
from tests.render.build import Builder, camera, floor, grey, hexagon, sky
from tests.render.statistics import INTEGRATORS, Array, Measurement, Pictures, repeat

LEVEL = 1e-3
"""Of all comparisons together: how often an engine that has not changed would fail, had the seeds not been fixed."""
SAMPLES = 16
SEEDS = 64
COMMITTED_SEEDS = 512
FIRST_COMMITTED_SEED = 1 << 30


def haze() -> d.SceneDescription:
    """Two moons in fog over a grey floor: scattering of every order."""
    scene = Builder(camera((0, -6, 2.5), (0, 4, 1.5), 60), 16, 16, medium=d.Medium(grey(0.004), grey(0.08)))
    scene.mesh(floor(0, 12), d.Lambert(grey(0.5)))
    return scene.sphere((-2, 5, 3), 1, d.Light((6, 2, 1))).sphere((3, 9, 4), 1.5, d.Light((1, 2, 6))).done()


def plates() -> d.SceneDescription:
    """Rough metal plates under a moon and a sky, without fog."""
    scene = Builder(camera((0, -4, 2), (0, 2, 0.2), 60), 16, 16, environment=sky(0.2))
    places = np.tile(np.eye(4), (9, 1, 1))
    places[:, :3, 3] = [(2 * i, 2 * j + 2, 0.15 * i * j) for i in (-1, 0, 1) for j in (-1, 0, 1)]
    scene.mesh(hexagon(1, 0.6), d.Conductor(0.4, f0=(0.9, 0.8, 0.7)), instances=places)
    return scene.sphere((-2, 5, 3), 1, d.Light((6, 4, 2))).done()


WORLDS = {"haze": haze, "plates": plates}

COMMITTED: dict[tuple[str, str], tuple[float, float]] = {
    ("haze", "path"): (0.2886, 0.0061),
    ("haze", "baseline"): (4.397, 0.048),
    ("plates", "path"): (0.1206, 0.0024),
    ("plates", "baseline"): (0.2298, 0.0026),
}
"""Variance of one sample and its standard error, by scene and integrator."""


def variance_of_a_sample(name: str, integrator: str, seeds: int, first: int) -> tuple[float, float]:
    """Mean over pixels and channels of Var(sample)/(mu^2 + eps), and its standard error: a jackknife over the seeds."""
    pictures: Array = repeat(Pictures(Measurement(WORLDS[name](), integrator, SAMPLES)), seeds, first)
    total, squares = pictures.sum(axis=0), (pictures**2).sum(axis=0)
    scale = SAMPLES / ((total / seeds) ** 2 + 1e-4 * (total.mean() / seeds) ** 2)

    def value(n: int, s: Array, q: Array) -> float:
        return float(((q - s**2 / n) / (n - 1) * scale).mean())

    without = [value(seeds - 1, total - x, squares - x**2) for x in pictures]
    return value(seeds, total, squares), float(np.sqrt((seeds - 1) * np.var(without)))


@pytest.mark.parametrize("name", WORLDS)
@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_sample_is_no_noisier_than_it_was(name: str, integrator: str) -> None:
    before, before_error = COMMITTED[name, integrator]
    now, error = variance_of_a_sample(name, integrator, SEEDS, 0)
    z = (now - before) / np.hypot(error, before_error)
    allowed = stats.norm.isf(LEVEL / len(COMMITTED))
    assert z < allowed, f"the variance of a sample is {now:.4g} +- {error:.2g}, was {before:.4g}: z = {z:.1f}"
    seen = allowed * np.hypot(error, before_error) / before
    assert seen < 0.5, f"no evidence: only a growth by {seen:.0%} would be found"


if __name__ == "__main__":
    for world in WORLDS:
        for method in INTEGRATORS:
            figure, unsure = variance_of_a_sample(world, method, COMMITTED_SEEDS, FIRST_COMMITTED_SEED)
            sys.stdout.write(f'    ("{world}", "{method}"): ({figure:.4g}, {unsure:.2g}),\n')
