# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures a case and judges it."""

import time
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from tests.check.case import Case
from tests.render.statistics import LEVEL, Clock, Comparison, Verdict, compare_mean

LIMIT, STALE = "limit", "limit no longer needed"


@dataclass(frozen=True)
class Result:
    case: str
    integrator: str
    expected: float
    """The number that stands out most, of those that the case compares."""
    measured: float | None
    half_width: float | None
    """Of the interval at the level of the case, absolute."""
    verdict: str
    seeds: int
    seconds_to_one_percent: float | None
    """CPU seconds of the engine until the standard error is 1 % of what is expected; None where there is no noise."""
    seconds: float
    """That the case took, wall time."""
    text: str

    @property
    def good(self) -> bool:
        return self.verdict in (Verdict.PASSES.value, LIMIT)


def numbers(cases: Sequence[Case]) -> int:
    """How many comparisons share the level."""
    return sum(np.size(case.expected) for case in cases)


def _seconds(case: Case, comparison: Comparison, per_seed: float) -> float | None:
    """To a standard error of 1 %, for the noisiest number."""
    e: NDArray[np.float64] = np.atleast_1d(np.asarray(case.expected, np.float64))
    bright = e != 0
    one_seed = comparison.interval.error[bright] * np.sqrt(comparison.interval.seeds) / np.abs(e[bright])
    noise = float(one_seed.max(initial=0))
    return per_seed * (noise / 0.01) ** 2 if noise > 1e-6 else None


def _judge(case: Case, integrator: str, comparison: Comparison | None) -> str:
    """A case with a limit must fail, and by no more than it says; where noise is the limit, chance decides. comparison:
    None where rendering itself failed."""
    limit = case.limit if case.limit is not None and integrator in case.limit.integrators else None
    if comparison is not None and comparison.verdict is Verdict.PASSES:
        return comparison.verdict.value if limit is None or np.isinf(limit.error) else STALE
    if limit is None or (comparison is None and np.isfinite(limit.error)):
        return Verdict.FAILS.value if comparison is None else comparison.verdict.value
    if comparison is None or np.isinf(limit.error):
        return LIMIT
    e: NDArray[np.float64] = np.atleast_1d(np.asarray(case.expected, np.float64))
    off = np.abs(comparison.interval.mean - e)
    within = comparison.verdict is Verdict.FAILS and off.max() <= limit.error * np.abs(e).max()
    return LIMIT if within else comparison.verdict.value


def run(case: Case, integrator: str, comparisons: int) -> Result:
    """comparisons: among which LEVEL is shared."""
    e: NDArray[np.float64] = np.atleast_1d(np.asarray(case.expected, np.float64))
    level, clock = LEVEL / comparisons, Clock()
    renders, started = 0, time.monotonic()

    try:
        estimate = case.measure(integrator, clock)

        def counted(seed: int) -> NDArray[np.float64]:
            nonlocal renders
            renders += 1
            return np.asarray(estimate(seed), np.float64)

        comparison = compare_mean(
            counted,
            case.expected,
            level=level,
            within=case.within,
            rounding=case.rounding,
            most_seeds=case.most_seeds,
        )
    except AssertionError as error:  # a sample that is not finite, light where none may be
        verdict, took = _judge(case, integrator, None), time.monotonic() - started
        return Result(case.name, integrator, float(e[0]), None, None, verdict, renders, None, took, str(error))
    interval = comparison.interval
    worst = interval.worst
    return Result(
        case.name,
        integrator,
        float(e[worst]),
        float(interval.mean[worst]),
        float(stats.t.isf(level / 2, interval.seeds - 1) * interval.error[worst]),
        _judge(case, integrator, comparison),
        interval.seeds,
        _seconds(case, comparison, clock.seconds / max(renders, 1)),
        time.monotonic() - started,
        interval.text,
    )
