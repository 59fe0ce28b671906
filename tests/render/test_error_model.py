# SPDX-License-Identifier: GPL-3.0-or-later
"""The estimate of the error, its interval, the verdict on the tails and the stopping rule, on samples whose
distribution is known. LEVEL is what each test may be wrong by, had the seeds not been fixed."""

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import stats

from tests.engine.probe.film import fall_rate, student_quantile
from tests.render.error_models import (
    REPLICATES,
    SIZE,
    Model,
    estimate,
    exponential,
    fireflies,
    gaussian,
    pareto,
    render,
    replicate_samples,
    same_sample_relmse,
)

LEVEL = 1e-3
CONFIDENCE = 0.95

LIGHT = (gaussian(0.3), gaussian(0.3, 100), exponential())
FIREFLIES = (fireflies(1e-2, 10), fireflies(1e-3, 30), fireflies(1e-3, 300), pareto(2.5, 0.5), pareto(2.1, 0.9))


def named(models: tuple[Model, ...]) -> pytest.MarkDecorator:
    return pytest.mark.parametrize("model", models, ids=lambda model: model.name)


def expect_share(hits: int, runs: int, what: str) -> None:
    """At least CONFIDENCE of the runs, within their binomial error."""
    assert stats.binom.cdf(hits, runs, CONFIDENCE) > LEVEL, f"{what}: {hits} of {runs}"


@pytest.mark.parametrize("degrees", [1, 2, 3, 4, 5, 6, 7, 20, 99])
def test_quantiles_of_student(degrees: int) -> None:
    for tail in (0.49, 0.1, 0.025, 1e-3, 1e-5, 1e-8):
        expected = float(stats.t.isf(tail, degrees))
        assert student_quantile(tail, degrees) == pytest.approx(expected, rel=1e-6), tail


@pytest.mark.parametrize("samples", [4, 5, 7, 8, 12, 13, 64])
def test_unbiased_where_pixels_are_well_known(samples: int) -> None:
    """Replicates of unequal size, too. 1 % of noise: what is left of the noise of mu is below 1e-3 of the error."""
    model = gaussian(0.01, 100)
    values = []
    for seed in range(200):
        rng = np.random.default_rng(seed)
        sums = np.stack([model.draw(rng, n) if n else 0 * model.mean for n in replicate_samples(samples)], axis=2)
        values.append(estimate(sums, samples).relmse / model.relmse(samples))
    z = (np.mean(values) - 1) / np.hypot(stats.sem(values), 1e-3)
    assert abs(z) < stats.norm.isf(LEVEL / 2 / 7), f"{np.mean(values):.4f}, z = {z:.1f}"
    assert stats.sem(values) < 0.01, "no evidence"


@named(LIGHT)
def test_all_looks_at_once(model: Model) -> None:
    """The interval holds the expected relMSE at every look of a render, in 95 % of renders; all of them certified."""
    runs = 200
    held, certified = 0, 0
    for seed in range(runs):
        looks = list(render(model, seed, 256))
        held += all(look.estimate.low <= model.relmse(look.samples) <= look.estimate.high for look in looks)
        certified += looks[-1].estimate.certifiable
    expect_share(held, runs, model.name)
    assert certified == runs


@named(LIGHT)
def test_an_interval_that_says_something(model: Model) -> None:
    """At 256 samples it is narrower than what two doublings of the samples gain."""
    widths = [look.estimate.high / look.estimate.low for seed in range(20) for look in render(model, seed, 256, 256)]
    assert np.median(widths) < 4


@named(FIREFLIES)
def test_certified_is_true(model: Model) -> None:
    """Of all looks that are certified, at most 5 % have made a larger error than the interval's upper end; and the
    estimate with both from the same samples would have, by the same interval, where fireflies are rare."""
    held: dict[int, list[bool]] = {}
    for seed in range(150):
        for look in render(model, seed, 512):
            if look.estimate.certifiable and look.samples >= 2 * REPLICATES:
                held.setdefault(look.samples, []).append(model.error_of(look.picture) <= look.estimate.high)
    for samples, hits in held.items():
        expect_share(sum(hits), len(hits), f"{model.name} at {samples} samples")


def test_variance_and_mean_from_the_same_samples_would_fail() -> None:
    """The tests above can fail: the former estimate is too low by far, and so is its upper end."""
    model = fireflies(1e-3, 300)
    below, ratios = 0, []
    for seed in range(50):
        (look,) = render(model, seed, 64, 64)
        former = same_sample_relmse(look.sums, 64)
        factor = np.exp(stats.t.isf(0.025, 7) * look.estimate.log_error)
        below += former * factor < model.error_of(look.picture)
        ratios.append(former / model.relmse(64))
    assert np.median(ratios) < 0.5 and stats.binom.sf(below - 1, 50, 1 - CONFIDENCE) < LEVEL


def test_one_firefly_is_no_certificate() -> None:
    """A flat picture and a single bright sample: nothing is certified, and the place is named."""
    sums = np.random.default_rng(1).normal(8, 0.01, (SIZE, SIZE, REPLICATES))
    assert estimate(sums, 64).certifiable
    sums[5, 11, 3] += 100
    found = estimate(sums, 64)
    assert not found.certifiable and found.largest_share > 0.5
    assert (found.x, found.y) == (11, 5)
    noiseless = np.full((SIZE, SIZE, REPLICATES), 8.0)
    assert estimate(noiseless, 64).high == 0 and estimate(noiseless, 64).certifiable
    noiseless[5, 11, 3] += 100
    assert estimate(noiseless, 64).high == np.inf


@named((*LIGHT, *FIREFLIES[:3]))
def test_stopping(model: Model) -> None:
    """Stops at the first look whose upper end is at the target and whose tails are light: the error of the picture is
    at the target in 95 % of the renders that stop, and the mean of the pictures is the truth (z-test)."""
    target = model.relmse(64)
    met, means, samples = [], [], []
    for seed in range(150):
        for look in render(model, 1000 + seed, 1024):
            if look.meets(target):
                met.append(model.error_of(look.picture) <= target)
                break
        means.append(float((look.picture / model.mean).mean()))
        samples.append(look.samples)
    expect_share(sum(met), len(met), model.name)
    assert len(met) >= 75 or model in FIREFLIES, f"only {len(met)} of 150 stopped"
    z = (np.mean(means) - 1) / stats.sem(means)
    assert abs(z) < stats.norm.isf(LEVEL / 2), f"the mean is {np.mean(means):.5f}, z = {z:.1f}"


def test_rate_of_independent_samples_is_one() -> None:
    """Seconds proportional to samples: the interval of the fitted rate holds 1 in 95 % of renders."""
    model, runs = gaussian(0.3), 200
    held, widths = 0, []
    for seed in range(runs):
        looks = [look.estimate for look in render(model, seed, 256)]
        columns: list[NDArray[np.float64]] = [
            np.array([getattr(e, name) for e in looks]) for name in ("relmse", "log_error", "without")
        ]
        # The engine counts samples from 1 on: two more points stand before the first look.
        unknown = [np.concatenate([np.full((2, *c.shape[1:]), np.nan), c]) for c in columns]
        power, low, high = fall_rate(2.0 ** np.arange(len(unknown[0])), *unknown)
        assert low < power < high
        held += low <= 1 <= high
        widths.append(high - low)
    expect_share(held, runs, "rate")
    assert np.median(widths) < 1
