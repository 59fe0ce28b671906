# SPDX-License-Identifier: GPL-3.0-or-later
"""What is made of the replicates of a film: the estimate of its error, how fast it falls, adaptive sampling's plan."""

import ctypes
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tests.engine.probe.call import Array, call, f32


class ErrorEstimate(NamedTuple):
    """Of engine/src/film/error.h."""

    relmse: float
    low: float
    high: float
    largest_share: float
    x: int
    y: int
    log_error: float
    without: Array  # (8)

    @property
    def certifiable(self) -> bool:
        return self.largest_share <= 0.1 or self.relmse == 0


def error_estimate(sums: ArrayLike, samples: int, look: int = 1) -> ErrorEstimate:
    """sums (height, width, 8, 3) of the replicates of a film after `samples` samples a pixel."""
    values = f32(sums)
    height, width, replicates, channels = values.shape
    assert (replicates, channels) == (8, 3)
    result = np.empty(15)
    call("probe_error", values, width, height, np.uint64(samples), look, result)
    relmse, low, high, share, x, y, log_error = map(float, result[:7])
    return ErrorEstimate(relmse, low, high, share, int(x), int(y), log_error, result[7:])


def student_quantile(tail: float, degrees: int) -> float:
    return float(call("probe_student_quantile", np.float64(tail), degrees, returns=ctypes.c_double))


def fall_rate(
    seconds: ArrayLike, relmse: ArrayLike, log_error: ArrayLike, without: ArrayLike
) -> tuple[float, float, float]:
    """power, low, high of a curve of n points, at 1, 2, 4, ... samples; without: (n, 8)."""
    arrays = [np.ascontiguousarray(a, np.float64) for a in (seconds, relmse, log_error, without)]
    result = np.empty(3)
    call("probe_rate", *arrays, np.uint64(len(arrays[0])), result)
    return float(result[0]), float(result[1]), float(result[2])


def sample_allocation(sums: ArrayLike) -> Array:
    """(height, width, 8) samples a pass that adaptive sampling plans for replicates whose sums (height, width, 8, 3)
    are these after two passes of each."""
    values = f32(sums)
    height, width, replicates, channels = values.shape
    assert (replicates, channels) == (8, 3)
    rates = np.empty((height, width, 8), np.float32)
    call("probe_allocation", values, width, height, rates)
    return rates
