# SPDX-License-Identifier: GPL-3.0-or-later
"""What a render says of its own error, against its true error in furnaces, where every pixel must be 1."""

import numpy as np
import pytest
from scipy import stats

from addon.scene import description as d
from tests.engine.library import Render, Scene
from tests.render.build import BLACK, WHITE, Builder, camera, grey
from tests.render.statistics import INTEGRATORS, Array, check_mean, pool, repeat

PIXELS = 24


def furnace() -> Scene:
    """White fog and a white ball within a shining one."""
    scene = Builder(camera((0.4, -1, 0.3), (0, 1, 0), 80), PIXELS, PIXELS, medium=d.Medium(BLACK, grey(0.3), 0.2))
    return Scene(scene.sphere((0, 0, 0), 2, d.Light(WHITE)).sphere((0, 0.5, 0), 0.5, d.Lambert(WHITE)).done())


def measure(scene: Scene, integrator: str, samples: int, seed: int) -> tuple[Array, Array, tuple[float, float, float]]:
    """Squared true errors and squared standard errors (height, width), and relMSE with its interval."""
    with Render(scene, integrator=integrator, samples=samples, seed=seed, threads=1, passes=("stderr",)) as render:
        progress = render.run().poll()
        picture, stderr = (render.read(name).astype(np.float64)[..., 0] for name in ("combined", "stderr"))
        return (picture - 1) ** 2, stderr**2, (progress.relmse, progress.relmse_low, progress.relmse_high)


@pytest.mark.parametrize("samples", [2, 5, 8, 24])
@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_standard_errors(integrator: str, samples: int) -> None:
    """In the mean their squares are the squared errors: also where replicates hold unequal numbers of samples."""
    scene = furnace()

    def ratio_parts(seed: int) -> tuple[float, float]:
        true, claimed, _ = measure(scene, integrator, samples, seed)
        return float(true.mean()), float(claimed.mean())

    scale = repeat(ratio_parts, 16, 1 << 50).mean()

    def one_plus_difference(seed: int) -> float:
        true, claimed = ratio_parts(seed)
        return 1 + (claimed - true) / float(scale)

    check_mean(one_plus_difference, 1, within=0.1, what=f"{integrator} at {samples} samples")


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_relmse(integrator: str) -> None:
    """The estimate and its 95 % interval against the true relMSE.

    Each pixel's variance is divided by an estimated square, which makes the estimate low by about 1.5 relMSE of itself
    here (18 % at 4 samples of `report`, 4 % at 16): the interval knows nothing of that, so it is tested at 64.
    """
    scene = furnace()
    runs, samples = 128, 64
    results = list(pool.map(lambda seed: measure(scene, integrator, samples, seed), range(runs)))
    true = np.array([error.mean() / (1 + 1e-4) for error, _, _ in results])
    claimed, low, high = np.array([interval for _, _, interval in results]).T
    truth, unsure = true.mean(), 4 * stats.sem(true) / true.mean()
    bias = claimed.mean() / truth - 1
    slack = unsure + 2 * truth + 4 * stats.sem(claimed) / truth
    assert slack < 0.06, f"no evidence: {slack:.1%}"
    assert abs(bias) <= slack, f"the estimate is off by {bias:+.1%}, allowed: {slack:.1%}"
    covered = int(((low <= truth) & (truth <= high)).sum())
    assert stats.binom.cdf(covered, runs, 0.9) > 1e-3, f"the interval held the truth {covered} of {runs} times"
    assert np.median(high / low) < 1.5, "so wide an interval says nothing"
