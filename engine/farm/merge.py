# SPDX-License-Identifier: GPL-3.0-or-later
"""The sums of a frame's ranges. They are added in the order of their numbers, so that the bits depend neither on how
many workers there were nor on who was first: a range that comes early waits.
"""

from __future__ import annotations

from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from .error import REPLICATES, ErrorEstimate, estimate
from .picture import Facts, Layout, Picture
from .ranges import Range

NO_DEPTH = np.float32(1e10)
RADIANCE = ("R", "G", "B")


class Rule(IntEnum):
    """glimmer_pass_rule."""

    MEAN = 0
    STANDARD_ERROR = 1
    MEAN_OF_HITS = 2
    FIRST = 3
    COUNT = 4
    MATTE = 5


class Sums:
    """Range i belongs to replicate i mod 8, as sample i of a film does."""

    def __init__(self, layout: Layout, pass_rules: dict[str, int]) -> None:
        """layout: of the ranges."""
        self._layout = layout
        height, width, _ = layout.shape
        self._radiance_at = [layout.channels.index(name) for name in RADIANCE]
        self._others = [i for i in range(len(layout.channels)) if i not in self._radiance_at]
        layers = [layout.channels[i].partition(".")[0] for i in self._others]
        self._rules = np.array([pass_rules.get(layer, Rule.MEAN) for layer in layers])
        self._radiance = np.zeros((REPLICATES, height, width, 3))
        self._sums = np.zeros((height, width, len(self._others)))
        self._hits = np.zeros((height, width, len(self._others)))
        self._counts = np.zeros(REPLICATES)
        self._waiting: dict[int, Range] = {}
        self.count = 0  # of ranges that are in the sums: 0 to count - 1
        self.samples = 0

    def has(self, index: int) -> bool:
        return index < self.count or index in self._waiting

    @property
    def waiting(self) -> int:
        return len(self._waiting)

    def put(self, item: Range) -> None:
        """A range is counted once, however often it comes."""
        if not self.has(item.index):
            self._waiting[item.index] = item

    def add_next(self) -> bool:
        """Adds the next range; False where it is not there yet."""
        item = self._waiting.pop(self.count, None)
        if item is None:
            return False
        replicate = self.count % REPLICATES
        self._radiance[replicate] += item.samples * item.pixels[..., self._radiance_at].astype(np.float64)
        if self._others:
            self._add_others(item)
        self._counts[replicate] += item.samples
        self.samples += item.samples
        self.count += 1
        return True

    def _add_others(self, item: Range) -> None:
        values = item.pixels[..., self._others].astype(np.float64)
        weights = np.full_like(values, item.samples)
        weights[..., self._rules == Rule.COUNT] = 1
        first = np.isin(self._rules, (Rule.FIRST, Rule.MATTE))
        weights[..., first] = 1 if self.count == 0 else 0
        hits = self._rules == Rule.MEAN_OF_HITS
        weights[..., hits] *= values[..., hits] < NO_DEPTH
        self._sums += weights * values
        self._hits += weights

    def error(self, look: int) -> ErrorEstimate:
        return estimate(self._radiance, self._counts, look)

    def _other_values(self) -> NDArray[np.float32]:
        hits = self._rules == Rule.MEAN_OF_HITS
        divisors = np.where(self._rules == Rule.MEAN, float(max(self.samples, 1)), 1.0) * np.ones_like(self._hits)
        divisors[..., hits] = self._hits[..., hits]
        result = np.divide(self._sums, divisors, out=np.zeros_like(self._sums), where=divisors > 0).astype(np.float32)
        result[np.broadcast_to(hits, result.shape) & (divisors <= 0)] = NO_DEPTH
        return result

    def picture(self, facts: Facts) -> Picture:
        """The mean, and its standard error where two replicates or more have ranges."""
        counts = self._counts[self._counts > 0]
        mean = self._radiance.sum(0) / self.samples
        names, planes = list(RADIANCE), [mean.astype(np.float32)]
        if len(counts) >= 2:
            spread = np.zeros_like(mean)
            for count, sums in zip(counts, self._radiance, strict=False):
                spread += count * (sums / count - mean) ** 2
            names += [f"stderr.{name}" for name in RADIANCE]
            planes.append(np.sqrt(spread / ((len(counts) - 1) * self.samples)).astype(np.float32))
        names += [self._layout.channels[i] for i in self._others]
        planes.append(self._other_values())
        layout = Layout(self._layout.width, self._layout.height, self._layout.window, tuple(names))
        return Picture(layout, facts, np.concatenate(planes, axis=2))
