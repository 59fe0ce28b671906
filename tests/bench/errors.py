# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors of pictures against a noisy reference, whether two renderers show the same picture, and error against time."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import stats

Picture = NDArray[np.float32]  # (height, width, 3), linear

CONFIDENCE = 0.95
_BLOCKS = (2, 3)  # down and across
TESTS_PER_PAIR = 3 * (_BLOCKS[0] * _BLOCKS[1] + 1)


def relative_errors(picture: Picture, thirds: Sequence[Picture]) -> NDArray[np.float64]:
    """(x - a)(x - b) / (c^2 + (0.01 m)^2) for each pixel and channel, with m the mean of c; the mean of the three ways
    to take one of `thirds` for c. Its mean over the picture is the relMSE.

    The thirds of the reference are independent of each other and of the picture, so the expectation of the product is
    the squared error of the picture, with nothing of the reference's own. One half for both, product and denominator,
    would not do: it adds 1.5 times the square of the half's own error. What the noise of c does to the reciprocal is a
    factor that is the same for every picture. An estimate may be negative.
    """
    x, *parts = (np.asarray(image, np.float64) for image in (picture, *thirds))
    total = np.zeros(picture.shape)
    for index, c in enumerate(parts):
        a, b = (part for other, part in enumerate(parts) if other != index)
        total += (x - a) * (x - b) / (c**2 + (0.01 * c.mean()) ** 2)
    return total / 3


def worst_share(values: NDArray[np.float64]) -> float:
    """What the worst hundredth of the values has of their sum."""
    ordered = np.sort(values, axis=None)
    return float(ordered[-(ordered.size // 100) :].sum() / ordered.sum())


def noise_of(thirds: Sequence[Picture]) -> float:
    """The relMSE of the mean of the thirds, from their spread."""
    parts = np.stack(thirds).astype(np.float64)
    mu = parts.mean(axis=0)
    return float(np.mean(parts.var(axis=0, ddof=1) / 3 / (mu**2 + (0.01 * mu.mean()) ** 2)))


def block_means(picture: Picture, size: int = 32) -> Picture:
    """Means of blocks of size x size pixels, smaller at the right and at the bottom."""
    rows, columns = (np.arange(0, length, size) for length in picture.shape[:2])
    sums = np.add.reduceat(np.add.reduceat(picture.astype(np.float64), rows, axis=0), columns, axis=1)
    heights = np.diff(np.append(rows, picture.shape[0]))
    widths = np.diff(np.append(columns, picture.shape[1]))
    return np.asarray(sums / (heights[:, None, None] * widths[None, :, None]), np.float32)


@dataclass(frozen=True)
class Run:
    samples: float  # a pixel
    cpu: float  # seconds, of the render alone
    picture: Picture
    wall: float = 0.0
    invalid: int = 0  # samples that were not finite or were broken off
    peak_bytes: int = 0  # resident, of the whole process
    set_up: float | None = None  # seconds before the first sample


@dataclass(frozen=True)
class Agreement:
    p: float  # the least of TESTS_PER_PAIR
    ratio: float  # of the means of the pictures to the reference's
    error: float  # its standard error


def _regions(pictures: NDArray[np.float64]) -> NDArray[np.float64]:
    """Means of the blocks and of the whole, by channel: (runs, TESTS_PER_PAIR)."""
    rows = [
        part for half in np.array_split(pictures, _BLOCKS[0], axis=1) for part in np.array_split(half, _BLOCKS[1], 2)
    ]
    return np.concatenate([part.mean(axis=(1, 2)) for part in [*rows, pictures]], axis=1)


def _mean_and_variance(
    values: NDArray[np.float64], samples: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Of independent runs, first axis, weighed by their samples: variances are taken as proportional to 1/samples.
    Where they fall faster, as with stratified samples, the variance comes out too large rather than too small.
    """
    weights = (samples / samples.sum())[:, np.newaxis]
    mean = (weights * values).sum(axis=0)
    return mean, (weights * (values - mean) ** 2).sum(axis=0) / (len(values) - 1)


def agreement(runs: Sequence[Run], reference: Sequence[Run]) -> Agreement:
    """Welch's t-test on the means of regions. All runs must be independent: no two of a renderer with one seed."""
    sides = []
    for side in (runs, reference):
        pictures = np.stack([run.picture for run in side]).astype(np.float64)
        samples = np.array([run.samples for run in side], np.float64)
        sides.append((_regions(pictures), pictures.mean(axis=(1, 2, 3))[:, np.newaxis], samples))
    (mean, variance), (mean_0, variance_0) = (_mean_and_variance(regions, n) for regions, _, n in sides)
    total = np.maximum(variance + variance_0, 1e-300)
    freedom = total**2 / (variance**2 / (len(runs) - 1) + variance_0**2 / (len(reference) - 1) + 1e-300)
    # Where nothing is random, sums of float32 in another order still differ.
    t = np.abs(mean - mean_0) / np.sqrt(total + (2e-6 * mean_0) ** 2)
    p = 2 * stats.t.sf(t, np.maximum(freedom, min(len(runs), len(reference)) - 1))
    (whole, spread), (whole_0, spread_0) = (_mean_and_variance(image, n) for _, image, n in sides)
    ratio = float(whole[0] / whole_0[0])
    return Agreement(
        float(p.min()), ratio, ratio * math.sqrt(spread[0] / whole[0] ** 2 + spread_0[0] / whole_0[0] ** 2)
    )


@dataclass(frozen=True)
class Point:
    samples: float
    cpu: float
    wall: float
    error: float  # relMSE
    block: float  # the same of the means of blocks of 32 x 32 pixels
    worst: float  # share of the relMSE that is the worst hundredth's of pixels and channels


@dataclass(frozen=True)
class Line:
    """relMSE = scale * cpu^-power, by least squares on the logarithms."""

    scale: float
    power: float

    def seconds(self, target: float) -> float:
        return float((self.scale / target) ** (1 / self.power))


def mean_points(points: Sequence[Sequence[Point]]) -> list[Point]:
    """One for each level: points[repetition][level]. Medians of seconds, which a busy machine spoils; means of errors,
    which are expectations.
    """
    return [
        Point(
            *(float(np.median([getattr(p, key) for p in level])) for key in ("samples", "cpu", "wall")),
            *(float(np.mean([getattr(p, key) for p in level])) for key in ("error", "block", "worst")),
        )
        for level in zip(*points, strict=True)
    ]


def fit(points: Sequence[Point], kind: str = "error") -> Line | None:
    """Of errors by pixel ("error") or by block ("block"). None where no line falls through the points: fewer than two,
    an error that is not positive, no decrease.
    """
    errors = [getattr(point, kind) for point in points]
    if len(points) < 2 or min(errors) <= 0:
        return None
    slope, intercept = np.polyfit(np.log([p.cpu for p in points]), np.log(errors), 1)
    return Line(float(np.exp(intercept)), -float(slope)) if slope < 0 else None


@dataclass(frozen=True)
class TimeTo:
    """CPU seconds until a target; the truth is within seconds / factor and seconds * factor, by CONFIDENCE."""

    seconds: float
    factor: float
    extrapolated: bool  # the target lies outside the measured errors
    at_most: bool  # a single sample has a smaller error already: the time of that sample


def time_to(points: Sequence[Sequence[Point]], target: float, kind: str = "error") -> TimeTo | None:
    """By the line through the mean points, with a jackknife over the repetitions."""
    means = mean_points(points)
    line = fit(means, kind)
    if line is None:
        return None
    first = min(means, key=lambda point: point.samples)
    if first.samples == 1 and getattr(first, kind) <= target:
        return TimeTo(first.cpu, 1.0, False, True)
    count = len(points)
    logs = []
    for left_out in range(count):
        part = fit(mean_points([row for index, row in enumerate(points) if index != left_out]), kind)
        if part is None:
            return None
        logs.append(math.log(part.seconds(target)))
    error = math.sqrt((count - 1) * float(np.var(logs)))
    errors = [getattr(point, kind) for point in means]
    factor = math.exp(float(stats.t.ppf((1 + CONFIDENCE) / 2, count - 1)) * error)
    return TimeTo(line.seconds(target), factor, not min(errors) <= target <= max(errors), False)
