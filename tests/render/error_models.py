# SPDX-License-Identifier: GPL-3.0-or-later
"""Films of samples whose distribution is known, to hold the estimate of the error against: no rendering, all truths in
closed form."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tests.engine.probe.film import ErrorEstimate, error_estimate

Array = NDArray[Any]
SIZE = 16
REPLICATES = 8


@dataclass(frozen=True)
class Model:
    """Independent grey samples of SIZE x SIZE pixels."""

    name: str
    mean: Array  # (SIZE, SIZE)
    variance: Array  # of one sample
    draw: Callable[[np.random.Generator, int], Array]
    """(SIZE, SIZE): the sum of so many samples of every pixel."""

    def relmse(self, samples: int) -> float:
        """Expected."""
        return float((self.variance / (self.mean**2 + self.epsilon)).mean() / samples)

    @property
    def epsilon(self) -> float:
        return 1e-4 * float(self.mean.mean()) ** 2

    def error_of(self, picture: Array) -> float:
        """What became of it."""
        return float(((picture - self.mean) ** 2 / (self.mean**2 + self.epsilon)).mean())


def gaussian(deviation: float, contrast: float = 1) -> Model:
    """Samples of `deviation` times the mean, the means spread by up to `contrast`: the lightest of tails."""
    mean = np.geomspace(1, contrast, SIZE * SIZE).reshape(SIZE, SIZE)
    sigma = deviation * mean
    return Model(
        f"gaussian {deviation} {contrast}",
        mean,
        sigma**2,
        lambda rng, n: n * mean + np.sqrt(n) * sigma * rng.standard_normal(mean.shape),
    )


def exponential() -> Model:
    mean = np.ones((SIZE, SIZE))
    return Model("exponential", mean, mean**2, lambda rng, n: rng.gamma(n, 1, mean.shape))


def fireflies(probability: float, brightness: float) -> Model:
    """Exponential noise about a mean of 0.5, and now and then a sample that is brighter by `brightness`."""
    mean = np.full((SIZE, SIZE), 0.5 + probability * brightness)
    variance = np.full((SIZE, SIZE), 0.25 + probability * (1 - probability) * brightness**2)
    return Model(
        f"fireflies {probability} {brightness}",
        mean,
        variance,
        lambda rng, n: rng.gamma(n, 0.5, mean.shape) + brightness * rng.binomial(n, probability, mean.shape),
    )


def pareto(index: float, share: float) -> Model:
    """1 - share, and `share` with sizes of a power law P(> x) = x^-index: the variance is finite for index > 2."""
    scale = (index - 1) / index
    mean = np.ones((SIZE, SIZE))
    variance = share**2 * (scale**2 * index / (index - 2) - 1)

    def draw(rng: np.random.Generator, n: int) -> Array:
        return n * (1 - share) + share * scale * (1 + rng.pareto(index, (SIZE, SIZE, n))).sum(axis=2)

    return Model(f"pareto {index} {share}", mean, np.full(mean.shape, variance), draw)


@dataclass(frozen=True)
class Look:
    samples: int
    picture: Array
    sums: Array  # (SIZE, SIZE, 8): of the replicates
    estimate: ErrorEstimate

    def meets(self, target: float) -> bool:
        """As CurvePoint::meets of the engine."""
        return self.samples >= 2 * REPLICATES and self.estimate.certifiable and self.estimate.high <= target


def replicate_samples(samples: int) -> list[int]:
    return [(samples + REPLICATES - 1 - r) // REPLICATES for r in range(REPLICATES)]


def estimate(sums: Array, samples: int, look: int = 1) -> ErrorEstimate:
    return error_estimate(np.repeat(sums[..., None], 3, axis=-1), samples, look)


def render(model: Model, seed: int, most: int = 1 << 10, first: int = 4) -> Iterator[Look]:
    """A render's looks, at the doublings from `first` on."""
    rng = np.random.default_rng(seed)
    sums = np.zeros((SIZE, SIZE, REPLICATES))
    have = [0] * REPLICATES
    look, samples = 0, first
    while samples <= most:
        for r, count in enumerate(replicate_samples(samples)):
            if count > have[r]:
                sums[..., r] += model.draw(rng, count - have[r])
            have[r] = count
        look += 1
        yield Look(samples, sums.sum(axis=2) / samples, sums, estimate(sums, samples, look))
        samples *= 2


def same_sample_relmse(sums: Array, samples: int) -> float:
    """Variance and mean from the same samples: what the engine said before, as the estimator that must fail. Whole
    replicates only."""
    means = sums * REPLICATES / samples
    mean = means.mean(axis=2)
    return float((means.var(axis=2, ddof=1) / REPLICATES / (mean**2 + 1e-4 * mean.mean() ** 2)).mean())
