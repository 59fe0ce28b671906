# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene whose picture is known by a formula, as data."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from addon.scene.description import SceneDescription
from tests.render.statistics import INTEGRATORS, MOST_SEEDS, ROUNDING, Clock, Measurement, Pictures

Estimate = Callable[[int], ArrayLike]
"""Of a seed: the numbers that it measured."""


@dataclass(frozen=True)
class Limit:
    """Why a case cannot pass, and how far off it is at most, relative to the largest number that it expects."""

    reason: str
    error: float
    """Infinite: also no evidence, or samples broken off."""
    integrators: tuple[str, ...] = INTEGRATORS


@dataclass(frozen=True)
class Case:
    name: str
    expected: ArrayLike
    measure: Callable[[str, Clock], Estimate]
    """Of an integrator's name and a clock for its CPU time."""
    within: float = 0.02
    """Widest relative half-width of the interval that is evidence."""
    rounding: float = ROUNDING
    """Relative error by float32 that comes on top."""
    quick: bool = False
    """Also in the short tier."""
    most_seeds: int = MOST_SEEDS
    integrators: tuple[str, ...] = INTEGRATORS
    limit: Limit | None = None
    scene: Callable[[], SceneDescription] | None = None
    """What is rendered, where it is one scene."""
    max_scatter: int = -1
    """Of that."""


def picture(
    name: str,
    scene: Callable[[], SceneDescription],
    expected: ArrayLike,
    *,
    samples: int = 1,
    max_scatter: int = -1,
    within: float = 0.02,
    rounding: float = ROUNDING,
    quick: bool = False,
    most_seeds: int = MOST_SEEDS,
    integrators: tuple[str, ...] = INTEGRATORS,
    limit: Limit | None = None,
) -> Case:
    """The mean of a whole picture is `expected`, a radiance or one a channel."""

    def measure(integrator: str, clock: Clock) -> Estimate:
        pictures = Pictures(Measurement(scene(), integrator, samples, max_scatter=max_scatter), clock)
        return lambda seed: pictures(seed).mean(axis=(0, 1))

    channels = np.broadcast_to(np.asarray(expected, np.float64), 3)
    return Case(name, channels, measure, within, rounding, quick, most_seeds, integrators, limit, scene, max_scatter)
