# SPDX-License-Identifier: GPL-3.0-or-later
"""What a program may give at most, as far as a look at its operations tells."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import inf, isfinite

import numpy as np

from ...scene.program import Op, Rgb, Table, Texture, in_order

Interval = tuple[float, float]
UNKNOWN: Interval = (-inf, inf)


def interval(value: Op | float | Rgb) -> Interval:
    """That all channels lie in everywhere; UNKNOWN where an operation that is none of the few here decides."""
    if not isinstance(value, Op):
        return _of_constant(value)
    known: dict[int, Interval] = {}
    for op in in_order([value]):
        of_inputs = [known[id(item)] if isinstance(item, Op) else _of_constant(item) for item in op.inputs]
        known[id(op)] = _of(op, of_inputs)
    return known[id(value)]


def _of_constant(value: float | Rgb) -> Interval:
    return (min(value), max(value)) if isinstance(value, tuple) else (value, value)


def _of(op: Op, inputs: Sequence[Interval]) -> Interval:
    mode = op.modes[0] if op.modes else ""
    if op.name in ("math", "blend", "map_range") and op.modes[-1] == "clamped":
        return 0.0, 1.0
    if op.name == "ramp" and isinstance(op.resource, Table):
        colors = op.resource.rows[:, :3]
        return float(colors.min()), float(colors.max())
    if op.name == "image" and isinstance(op.resource, Texture) and op.resource.pixels.dtype == np.uint8:
        return 0.0, 1.0
    if op.name in ("splat", "combine"):
        return _hull(inputs)
    if op.name == "clamp" and mode == "minmax":
        return max(inputs[0][0], inputs[1][0]), min(max(inputs[0][1], inputs[1][0]), inputs[2][1])
    if op.name in ("math", "vector_math") and mode in ARITHMETIC:
        return ARITHMETIC[mode](inputs[0], inputs[1])
    if op.name == "vector_math" and mode == "scale":
        return _product(inputs[0], inputs[3])
    if op.name == "blend" and mode == "mix" and _is_part(inputs[0]):
        return _hull(inputs[1:])
    return UNKNOWN


def _is_part(factor: Interval) -> bool:
    return factor[0] >= 0.0 and factor[1] <= 1.0


def _hull(items: Sequence[Interval]) -> Interval:
    return min(low for low, _ in items), max(high for _, high in items)


def _product(a: Interval, b: Interval) -> Interval:
    if not all(isfinite(end) for end in a + b):
        return UNKNOWN
    ends = [x * y for x in a for y in b]
    return min(ends), max(ends)


ARITHMETIC: dict[str, Callable[[Interval, Interval], Interval]] = {
    "add": lambda a, b: (a[0] + b[0], a[1] + b[1]),
    "subtract": lambda a, b: (a[0] - b[1], a[1] - b[0]),
    "multiply": _product,
    "minimum": lambda a, b: (min(a[0], b[0]), min(a[1], b[1])),
    "maximum": lambda a, b: (max(a[0], b[0]), max(a[1], b[1])),
}
