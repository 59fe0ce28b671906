# SPDX-License-Identifier: GPL-3.0-or-later
"""What tests/bench/claims.py makes of renders whose noise is known."""

import numpy as np
import pytest
from scipy import stats

from tests.bench.claims import LOOKS, Claim, errors_made, held, pixels

RNG = np.random.default_rng(20261122)
REPLICATES, SHAPE, SEEDS, LEVEL = 8, (24, 32, 3), 40, 1e-3
DEVIATION = 0.3  # of one sample, where the truth is 1


def render(samples: int, scale: float = 1) -> Claim:
    means = 1 + scale * RNG.normal(size=(REPLICATES, *SHAPE)) * DEVIATION / np.sqrt(samples / REPLICATES)
    stderr = means.std(axis=0, ddof=1) / np.sqrt(REPLICATES) / scale
    relmse = DEVIATION**2 / samples
    return Claim(relmse, relmse / 2, None, True, means.mean(axis=0), stderr)


@pytest.mark.parametrize("samples", LOOKS)
def test_errors_made(samples: int) -> None:
    claims, last = ([render(n) for _ in range(SEEDS)] for n in (samples, LOOKS[-1]))
    expected = DEVIATION**2 / samples / (1 + 1e-4)
    errors = errors_made(last if samples == LOOKS[-1] else claims, last, samples)
    # 1.0025 of it: the noise of mu in the denominator, 3 var / mu^2 / SEEDS at most.
    t = (errors.mean() / expected - 1) / np.hypot(stats.sem(errors) / expected, 3 * DEVIATION**2 / 64 / SEEDS)
    assert abs(t) < stats.t.isf(LEVEL / 2, SEEDS - 1)
    assert stats.sem(errors) < 0.02 * expected, "no evidence"


def test_an_interval_without_an_upper_end_holds_all_above() -> None:
    claims = [render(16)] * 2
    assert held(claims, np.array([claims[0].low * 0.9, 1e9])) == [False, True]


def test_standard_errors_of_pixels() -> None:
    """Student by construction."""
    ratio, inside, below = pixels([render(64) for _ in range(SEEDS)])
    count = SEEDS * int(np.prod(SHAPE))
    assert abs(ratio - 1) < stats.norm.isf(LEVEL / 2) * np.sqrt((2 + 2 / 7) / count)
    # The others' mean is no truth: it adds 1/39 to the variance.
    expected = 1 - 2 * stats.t.sf(stats.t.isf(0.025, 7) / np.sqrt(1 + 1 / 39), 7)
    assert abs(inside - expected) < stats.norm.isf(LEVEL / 2) * np.sqrt(expected * (1 - expected) / count)
    assert abs(below - 0.5) < 0.1
    # Errors twice as large as claimed.
    assert pixels([render(64, 2) for _ in range(SEEDS)])[0] < 0.3
