# SPDX-License-Identifier: GPL-3.0-or-later
"""How a noisy picture is held against what it must be in the mean.

A render is repeated with many independent seeds at a low sample count: what depends on the sample count shows there,
and the means over seeds are independent whatever the sampler does within one. Student's t on those means decides, at
LEVEL shared by at most COMPARISONS numbers (Bonferroni). A pilot run says how many seeds are needed and is then thrown
away (Stein 1945). A rejection is repeated once with fresh seeds and only then fails. A test whose interval is wider
than it states fails too, as "no evidence": it could not have found an error.
"""

import os
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from enum import Enum
from threading import Lock
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import stats

from addon.native.structs import State
from addon.scene.description import SceneDescription
from tests.engine.library import Render, Scene

Array = NDArray[Any]

LEVEL = 1e-3
"""Probability that a correct engine is rejected anywhere once, had the seeds not been fixed."""
COMPARISONS = 6400
"""Numbers that may be compared in one run of all tests."""
INTEGRATORS = ("path", "baseline")
ROUNDING = 64 * 2.0**-24
"""Relative: what a few dozen float32 operations on the way of a sample, and its sum, may add to the error of a mean."""
PILOT, FRESH = 1 << 40, 1 << 32
"""Added to the seeds of a pilot run, and when a rejection is repeated."""
PILOT_SEEDS, FEWEST_SEEDS, MOST_SEEDS = 16, 32, 2048

pool = ThreadPoolExecutor(os.cpu_count() or 1)


@dataclass
class Budget:
    """How many of the comparisons were made so far: by this process, or, once its workers are done, by all of them."""

    used: int = field(default=0)

    def take(self, n: int) -> float:
        """The level of one comparison."""
        self.add(n)
        return LEVEL / COMPARISONS

    def add(self, n: int) -> None:
        self.used += n
        assert self.used <= COMPARISONS, f"more than the {COMPARISONS} comparisons that the level was divided among"


budget = Budget()


@dataclass(frozen=True)
class Measurement:
    """A scene, and how to measure in it."""

    scene: SceneDescription
    integrator: str
    samples: int = 2
    max_depth: int = -1
    max_scatter: int = -1


class Clock:
    """Adds up the engine's CPU seconds over renders."""

    def __init__(self) -> None:
        self.seconds = 0.0
        self._lock = Lock()

    def add(self, seconds: float) -> None:
        with self._lock:
            self.seconds += seconds


class Pictures:
    """Renders of one committed scene, one a seed."""

    def __init__(self, measurement: Measurement, clock: Clock | None = None) -> None:
        self._measurement = measurement
        self._scene = Scene(measurement.scene)
        self._clock = clock or Clock()

    def __call__(self, seed: int) -> Array:
        """(height, width, 3) float64. Fails where a sample was not finite."""
        m = self._measurement
        with Render(
            self._scene,
            integrator=m.integrator,
            samples=m.samples,
            max_depth=m.max_depth,
            max_scatter=m.max_scatter,
            seed=seed,
            threads=1,
        ) as render:
            progress = render.run().poll()
            assert progress.state == State.FINISHED and progress.samples == m.samples
            assert progress.invalid_samples == 0, render.report()["invalid_samples"]
            biased_by = render.report()["biased_by"]
            assert m.max_depth >= 0 or m.max_scatter >= 0 or not biased_by, f"biased by {biased_by}"
            self._clock.add(progress.cpu_seconds)
            picture = render.read().astype(np.float64)
        assert np.isfinite(picture).all()
        return picture


def repeat(estimate: Callable[[int], ArrayLike], seeds: int, first: int = 0) -> Array:
    """(seeds, ...) values of estimate(seed), on all cores: the engine lets go of the interpreter's lock."""
    return np.array(list(pool.map(estimate, range(first, first + seeds))), np.float64)


class Verdict(Enum):
    PASSES = "passes"
    FAILS = "fails"
    NO_EVIDENCE = "no evidence"


@dataclass(frozen=True)
class Interval:
    """What some seeds said."""

    rejected: bool
    reached: float
    """Half-width of the widest interval, relative to what is expected."""
    text: str
    seeds: int = 0
    mean: Array = field(default_factory=lambda: np.zeros(0))
    error: Array = field(default_factory=lambda: np.zeros(0))
    """Standard errors of the means."""
    worst: int = 0
    """Which number is furthest from what it should be, in units of what it may be off."""


@dataclass(frozen=True)
class Comparison:
    verdict: Verdict
    interval: Interval


def _decide(run: Callable[[int, int], Interval], within: float, most_seeds: int = MOST_SEEDS) -> Comparison:
    """run(seeds, first): the verdict of so many seeds from `first` on."""

    def seeds_needed(seeds: int, reached: float) -> int:
        needed = 2 * seeds * (reached / within) ** 2 if within > 0 else 0
        return int(np.clip(np.ceil(needed), FEWEST_SEEDS, most_seeds))

    first, repeated = 0, False
    seeds = seeds_needed(PILOT_SEEDS, run(PILOT_SEEDS, PILOT).reached)
    while True:
        interval = run(seeds, first)
        first += FRESH
        if interval.reached > within:
            # The pilot had met none of the tail. What it took to see that is another pilot.
            if seeds >= most_seeds or within <= 0:
                return Comparison(Verdict.NO_EVIDENCE, interval)
            seeds = max(seeds_needed(seeds, interval.reached), min(2 * seeds, most_seeds))
        elif not interval.rejected:
            return Comparison(Verdict.PASSES, interval)
        elif repeated:
            return Comparison(Verdict.FAILS, interval)
        else:
            repeated = True


def _must_pass(comparison: Comparison, within: float, what: str) -> None:
    interval = comparison.interval
    assert comparison.verdict is not Verdict.NO_EVIDENCE, (
        f"{what}: no evidence: known to {interval.reached:.2%} only, {within:.2%} wanted; {interval.text}"
    )
    assert comparison.verdict is Verdict.PASSES, f"{what}: {interval.text}"


def compare_mean(
    estimate: Callable[[int], ArrayLike],
    expected: ArrayLike,
    *,
    level: float,
    within: float,
    rounding: float = ROUNDING,
    most_seeds: int = MOST_SEEDS,
) -> Comparison:
    """The mean over seeds of estimate(seed), (k) numbers or one, against `expected`, each at `level`.

    within: the widest relative half-width of the interval that still counts as evidence. rounding: relative error of
    float32 that comes on top. Where 0 is expected, every estimate must be 0.
    """
    e: Array = np.atleast_1d(np.asarray(expected, np.float64))
    dark = e == 0

    def run(seeds: int, first: int) -> Interval:
        values = np.broadcast_to(repeat(estimate, seeds, first).reshape(seeds, -1), (seeds, len(e)))
        assert not values[:, dark].any(), f"{np.abs(values[:, dark]).max():.3g} where nothing is expected"
        assert np.isfinite(values).all(), "a number that is not finite"
        mean, error = values.mean(axis=0), values.std(axis=0, ddof=1) / np.sqrt(seeds)
        half_width = stats.t.isf(level / 2, seeds - 1) * error
        off, slack = np.abs(mean - e), half_width + rounding * np.abs(e)
        worst = int(np.argmax(off / np.where(dark, 1, slack + 1e-300)))
        return Interval(
            bool((off > slack).any()),
            float((half_width[~dark] / np.abs(e[~dark])).max(initial=0)),
            f"{mean[worst]:.8g} +- {error[worst]:.2g} (standard error, {seeds} seeds), expected {e[worst]:.8g},"
            f" off by {(mean[worst] - e[worst]) / max(abs(e[worst]), 1e-300):+.3%}",
            seeds,
            mean,
            error,
            worst,
        )

    return _decide(run, within, most_seeds)


def check_mean(
    estimate: Callable[[int], ArrayLike],
    expected: ArrayLike,
    *,
    within: float,
    rounding: float = ROUNDING,
    what: str = "",
) -> None:
    """compare_mean must pass; its level is a share of this run's."""
    level = budget.take(np.size(expected))
    comparison = compare_mean(estimate, expected, level=level, within=within, rounding=rounding)
    _must_pass(comparison, within, what)


def check_same(
    a: Callable[[int], ArrayLike],
    b: Callable[[int], ArrayLike],
    *,
    within: float,
    what: str = "",
) -> None:
    """Two estimates of the same (k) numbers (Welch's t), and of their sum. within: of the sum's interval, relative.

    The first is given even seeds, the other odd ones: nothing that both draw is shared.
    """
    numbers = np.size(a(PILOT)) + 1
    level = budget.take(numbers)

    def run(seeds: int, first: int) -> Interval:
        means, variances = [], []
        for k, estimate in enumerate((a, b)):
            values = repeat(lambda seed, e=estimate, k=k: np.ravel(e(2 * seed + k)), seeds, first)  # type: ignore[misc]
            values = np.concatenate([values, values.sum(axis=1, keepdims=True)], axis=1)
            means.append(values.mean(axis=0))
            variances.append(values.var(axis=0, ddof=1) / seeds)
        total = variances[0] + variances[1]
        degrees = (seeds - 1) * total**2 / (variances[0] ** 2 + variances[1] ** 2 + 1e-300)
        scale = np.maximum(np.abs(means[0]), np.abs(means[1]))
        half_width = stats.t.isf(level / 2, np.maximum(degrees, 1)) * np.sqrt(total)
        off, slack = np.abs(means[0] - means[1]), half_width + ROUNDING * scale
        worst = int(np.argmax(off / (slack + 1e-300)))
        return Interval(
            bool((off > slack).any()),
            float(half_width[-1] / scale[-1]),
            f"{int((off > slack).sum())} of {numbers} differ; the worst, {worst}: {means[0][worst]:.6g} against"
            f" {means[1][worst]:.6g}, {off[worst] / np.sqrt(total[worst] + 1e-300):.1f} standard errors, {seeds} seeds",
        )

    _must_pass(_decide(run, within), within, what)


def check_radiance(
    measurement: Measurement,
    expected: ArrayLike,
    *,
    within: float,
    rounding: float = ROUNDING,
    what: str = "",
) -> None:
    """The mean of the whole picture against one radiance, or one a channel."""
    pictures = Pictures(measurement)
    channels = np.broadcast_to(np.asarray(expected, np.float64), 3)
    check_mean(
        lambda seed: pictures(seed).mean(axis=(0, 1)),
        channels,
        within=within,
        rounding=rounding,
        what=f"{measurement.integrator} {what}",
    )


def blocks(picture: Array, size: int) -> Array:
    """(rows, columns, 3) means of square blocks."""
    h, w, c = picture.shape
    assert h % size == 0 and w % size == 0
    means: Array = picture.reshape(h // size, size, w // size, size, c).mean(axis=(1, 3))
    return means


def strata(rng: np.random.Generator, n: int) -> Iterator[float]:
    """One uniform number in each n-th of [0, 1)."""
    yield from (np.arange(n) + rng.random(n)) / n
