# SPDX-License-Identifier: GPL-3.0-or-later
"""How wrong a merged picture is: engine/src/film/error.h, with whole ranges in the place of samples.

A film's replicates are sums of independent samples; here they are sums of ranges, which have seeds of their own and are
independent too. So the same estimate, the same interval over all looks and the same sign of heavy tails hold.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, cos, exp, inf, nan, pi, sin, sqrt

import numpy as np
from numpy.typing import NDArray

REPLICATES = 8
CONFIDENCE = 0.95
LARGEST_SHARE_ALLOWED = 0.1
_FEWEST_REPLICATES = 4
_BLOCK_PIXELS = 1 << 17  # at once: what is computed on the way is some 60 numbers a value

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class ErrorEstimate:
    """As `error` of a report. NaN where nothing is known."""

    relmse: float = nan
    low: float = nan
    high: float = nan
    largest_share: float = nan
    x: int = 0
    y: int = 0

    @property
    def certifiable(self) -> bool:
        return self.largest_share <= LARGEST_SHARE_ALLOWED or self.relmse == 0

    def meets(self, target: float) -> bool:
        return target > 0 and self.certifiable and self.high <= target

    def report(self) -> dict[str, object] | None:
        if self.relmse != self.relmse:
            return None
        known = self.low == self.low
        return {
            "relmse": self.relmse,
            "low": self.low if known else None,
            "high": self.high if known and self.high < inf else None,
            "confidence": CONFIDENCE,
            "tails": {
                "certifiable": self.certifiable,
                "largest_share": self.largest_share,
                "allowed": LARGEST_SHARE_ALLOWED,
                "x": self.x,
                "y": self.y,
            }
            if known
            else None,
        }


def student_quantile(tail: float, degrees: int) -> float:
    """t with P(T > t) = tail, by halving."""

    def above(t: float) -> float:
        theta = atan2(t, sqrt(degrees))
        c, s = cos(theta), sin(theta)
        total, term = 0.0, c if degrees % 2 else 1.0
        for k in range(3 if degrees % 2 else 2, degrees + 1, 2):
            total += term
            term *= c * c * (k - 1) / k
        within = (theta + s * total) * 2 / pi if degrees % 2 else s * total
        return (1 - within) / 2

    low, high = 0.0, 1.0
    while above(high) > tail:
        high *= 2
    for _ in range(80):
        middle = (low + high) / 2
        low, high = (middle, high) if above(middle) > tail else (low, middle)
    return (low + high) / 2


def _log_error(without: Floats) -> float:
    """The jackknife's standard error of the logarithm; infinite where one replicate carries everything."""
    if not (without > 0).all():
        return inf
    logs = np.log(without)
    return sqrt(float(((logs - logs.mean()) ** 2).sum()) * (len(logs) - 1) / len(logs))


class _Sums:
    """Over the values of the picture: with variance and mean from the same samples, and from different ones."""

    def __init__(self, counts: Floats, epsilon: float) -> None:
        self.counts, self.total, self.epsilon = counts, float(counts.sum()), epsilon
        self.used = len(counts)
        self.same, self.same_without = 0.0, np.zeros(self.used)
        self.crossed, self.crossed_without = 0.0, np.zeros(self.used)
        self.largest, self.at = 0.0, 0

    def add(self, sums: Floats, first_pixel: int) -> None:
        """sums: (replicates, pixels, 3)."""
        n = self.counts[:, None, None]
        origin = sums[0] / self.counts[0]  # sums of squares relative to it lose nothing
        x = sums / n - origin
        weighted = n * x
        squares = weighted * x
        s, q = weighted.sum(0), squares.sum(0)

        def same(count: float, s: Floats, q: Floats, groups: int) -> Floats:
            if groups < 2:
                return np.zeros_like(s)
            spread = np.maximum(q - s * s / count, 0)
            return np.asarray(spread / ((groups - 1) * self.total) / ((origin + s / count) ** 2 + self.epsilon))

        self.same += float(same(self.total, s, q, self.used).sum())
        for r in range(self.used):
            part = same(self.total - self.counts[r], s - weighted[r], q - squares[r], self.used - 1)
            self.same_without[r] += float(part.sum())
        if self.used < _FEWEST_REPLICATES:
            return

        pairs, pairs_of = np.zeros_like(s), np.zeros(self.used)
        for r in range(self.used):
            for p in range(r + 1, self.used):
                both = self.counts[r] + self.counts[p]
                count = self.total - both
                m = (s - weighted[r] - weighted[p]) / count
                spread = np.maximum(q - squares[r] - squares[p] - m * m * count, 0)
                unsure = 3 * spread / ((self.used - 3) * count)
                d = x[r] - x[p]
                value = d * d * (self.counts[r] * self.counts[p] / (both * self.total))
                value /= (origin + m) ** 2 + unsure + self.epsilon
                pairs += value
                total = float(value.sum())
                pairs_of[r] += total
                pairs_of[p] += total
        k = self.used
        whole = pairs.sum(1) / (k * (k - 1) / 2)  # of each pixel
        self.crossed += float(whole.sum())
        self.crossed_without += (float(pairs.sum()) - pairs_of) / ((k - 1) * (k - 2) / 2)
        mean = s / self.total
        scale = 1 / ((origin + mean) ** 2 + self.epsilon)
        deviations = (n * (x - mean) ** 2 * scale).sum(2)  # (replicates, pixels)
        all_of, most = deviations.sum(0), deviations.max(0)
        largest = np.divide(whole * most, all_of, out=np.zeros_like(whole), where=all_of > 0)
        at = int(largest.argmax())
        if largest[at] > self.largest:
            self.largest, self.at = float(largest[at]), first_pixel + at


def estimate(sums: Floats, counts: Floats, look: int) -> ErrorEstimate:
    """sums: (replicates, height, width, 3), of the samples of each replicate; counts: (replicates,) of its samples.
    look: 1 at the first estimate that has an interval.
    """
    used = int((counts > 0).sum())
    sums, counts = sums[:used], counts[:used]
    height, width = sums.shape[1:3]
    mean = float(sums.sum(0).mean() / counts.sum()) if used else 0.0
    if used < 2 or mean == 0:
        return ErrorEstimate()
    totals = _Sums(counts, 1e-4 * mean * mean)
    flat = sums.reshape(used, height * width, 3)
    for first in range(0, height * width, _BLOCK_PIXELS):
        totals.add(flat[:, first : first + _BLOCK_PIXELS], first)
    values = 3 * height * width
    if used < _FEWEST_REPLICATES:
        return ErrorEstimate(totals.same / values)
    relmse, share = totals.crossed / values, 0.0
    if totals.crossed == 0:
        return ErrorEstimate(0.0, 0.0, 0.0, 0.0)
    share = totals.largest / totals.crossed
    t = student_quantile((1 - CONFIDENCE) / (2 * look * (look + 1)), used - 1)

    def scaled(value: float, exponent: float) -> float:
        return value * exp(exponent) if exponent < 700 else inf

    log_error = _log_error(totals.crossed_without)
    low = min(scaled(totals.same / values, -t * _log_error(totals.same_without)), scaled(relmse, -t * log_error))
    y, x = divmod(totals.at, width)
    return ErrorEstimate(relmse, low, scaled(relmse, t * log_error), share, x, y)
