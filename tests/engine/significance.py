# SPDX-License-Identifier: GPL-3.0-or-later
"""Hypothesis tests for samplers: chi-squared against a density, z against a mean, at a level shared by a family."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import stats

Array = NDArray[Any]

LEVEL = 0.01
"""Probability that a correct engine fails anywhere in one family, had the seeds not been fixed."""


@dataclass
class Family:
    """All random tests of a file: each is held to LEVEL / size (Bonferroni), and there may be at most `size`."""

    size: int
    done: int = field(default=0)

    def check(self, p: float, what: str) -> None:
        self.done += 1
        assert self.done <= self.size, f"more than the {self.size} tests that the level was divided among"
        assert p >= LEVEL / self.size, f"{what}: p = {p:.3g}, below {LEVEL / self.size:.3g}"

    def chi_squared(self, observed: ArrayLike, expected: ArrayLike, what: str) -> None:
        """Counts against expected counts of the same shape; bins that expect fewer than 5 are merged."""
        o: Array = np.asarray(observed, np.float64).ravel()
        e: Array = np.asarray(expected, np.float64).ravel()
        assert np.isfinite(e).all(), f"{what}: expectations that are not finite"
        assert not o[e <= 0].any(), f"{what}: {o[e <= 0].sum():.0f} samples where the density is 0"
        o, e = o[e > 0], e[e > 0]
        order = np.argsort(e)
        o, e = o[order], e[order]
        small = e < 5
        if small.any():  # sorted: they stand first; take in further bins until the merged one expects 5
            end = int(small.sum())
            while e[:end].sum() < 5 and end < len(e):
                end += 1
            o, e = np.r_[o[:end].sum(), o[end:]], np.r_[e[:end].sum(), e[end:]]
        assert len(e) > 1, f"{what}: a single bin tests nothing"
        # What the density lacks of an integral of 1 may move chi-squared by 0.01 at most.
        missing = abs(e.sum() - o.sum())
        assert missing <= 0.1 * np.sqrt(o.sum()), f"{what}: the density integrates to {e.sum() / o.sum():.6f}"
        statistic = float(((o - e) ** 2 / e).sum())
        self.check(float(stats.chi2.sf(statistic, len(e) - 1)), f"{what}: chi-squared {statistic:.1f} at {len(e) - 1}")

    def mean(self, values: ArrayLike, expected: float, what: str, rounding: float = 0) -> None:
        """The mean of independent values against its expectation, by z. rounding: the error float32 adds, relative."""
        v = np.asarray(values, np.float64)
        error = np.hypot(v.std(ddof=1) / np.sqrt(len(v)), rounding * expected)
        assert error > 0, f"{what}: no spread to test by"
        z = (v.mean() - expected) / error
        self.check(
            float(2 * stats.norm.sf(abs(z))),
            f"{what}: {v.mean():.6g} +- {error:.2g}, expected {expected:.6g}, z = {z:.2f}",
        )


def bin_integrals(
    density: Callable[[Array, Array], Array], nx: int, ny: int, per_bin: tuple[int, int] = (16, 16)
) -> Array:
    """Integrals of density(x, y) over each of nx times ny equal bins of the unit square (Gauss-Legendre).

    density takes and gives shape (n), or gives (n, k) for k densities at once: then the result is (nx, ny, k).
    """

    def points(bins: int, order: int) -> tuple[Array, Array]:
        nodes, weights = np.polynomial.legendre.leggauss(order)
        x = (np.arange(bins)[:, None] + (nodes + 1) / 2) / bins
        return x.ravel(), np.tile(weights / (2 * bins), bins)

    (x, wx), (y, wy) = points(nx, per_bin[0]), points(ny, per_bin[1])
    values = np.asarray(density(*(a.ravel() for a in np.meshgrid(x, y, indexing="ij"))), np.float64)
    values = values.reshape(nx, per_bin[0], ny, per_bin[1], *values.shape[1:])
    sums: Array = np.einsum("aibj...,ai,bj->ab...", values, wx.reshape(nx, -1), wy.reshape(ny, -1))
    return sums


def histogram(x: ArrayLike, y: ArrayLike, nx: int, ny: int) -> Array:
    """Counts in the same bins; what lies outside the square by rounding counts at its edge."""
    cells = [np.clip((np.asarray(v) * n).astype(int), 0, n - 1) for v, n in ((x, nx), (y, ny))]
    return np.bincount(cells[0] * ny + cells[1], minlength=nx * ny).reshape(nx, ny)


def single(values: ArrayLike) -> Array:
    """As the engine takes them."""
    return np.asarray(values, np.float32)


def double(values: ArrayLike) -> Array:
    return np.asarray(values, np.float64)


def relative_error(values: ArrayLike, reference: ArrayLike) -> Array:
    v, r = np.asarray(values, np.float64), np.asarray(reference, np.float64)
    return np.abs(v - r) / np.abs(r)


ROUNDING = 2.0**-24
"""Half a unit in the last place of float32, relative: the error of one correctly rounded operation."""
