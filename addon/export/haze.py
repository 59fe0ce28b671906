# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds out whether a world's volume is haze that thins out exponentially with height, whatever nodes say so.

Its operations are computed at a few places: at two of one column to guess the law, then at others to confirm it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from ..scene.description import Falloff, Rgb
from ..scene.program import Op
from .translate.values import Triple

Point = tuple[float, float, float]
Values = tuple[float, ...]

# Differences of height that are tried, from the height of a mist to that of an atmosphere.
STEPS = tuple(10.0**k for k in range(-3, 7))
RELATIVE_ERROR = 1e-4


@dataclass(frozen=True)
class Haze:
    """Coefficients at a height of 0, and how they fall."""

    sigma_a: Rgb
    sigma_s: Rgb
    falloff: Falloff


class _UnknownOperationError(Exception):
    """Nothing that haze is made with."""


def height_haze(sigma_a: Triple, sigma_s: Triple) -> Haze | None:
    def density(z: float, x: float = 0.0, y: float = 0.0) -> Values:
        return (*_values(sigma_a, (x, y, z)), *_values(sigma_s, (x, y, z)))

    try:
        at_zero = density(0.0)
        if not any(at_zero) or min(at_zero) < 0.0:
            return None
        scale = _scale_height(density, max(range(6), key=at_zero.__getitem__))
        if scale is None or not all(
            _is_close(density(k * scale, 17.0 * k, -5.0 * k), [v * math.exp(-k) for v in at_zero])
            for k in (-4.0, -1.7, -0.5, 0.3, 1.0, 2.2, 4.0)
        ):
            return None
    except (_UnknownOperationError, OverflowError, ZeroDivisionError, ValueError):
        return None
    r, g, b, *rest = at_zero
    return Haze((r, g, b), (rest[0], rest[1], rest[2]), Falloff(0.0, scale))


def _scale_height(density: Callable[[float], Values], channel: int) -> float | None:
    at_zero = density(0.0)[channel]
    for step in STEPS:
        ratio = density(step)[channel] / at_zero
        if 0.0 < ratio < 0.9:
            return -step / math.log(ratio)
    return None


def _is_close(found: Values, expected: list[float]) -> bool:
    return all(abs(a - b) <= RELATIVE_ERROR * b for a, b in zip(found, expected, strict=True))


_MATH: dict[str, Callable[[float, float, float], float]] = {
    "add": lambda a, b, c: a + b,
    "subtract": lambda a, b, c: a - b,
    "multiply": lambda a, b, c: a * b,
    "divide": lambda a, b, c: a / b if b else 0.0,
    "multiply_add": lambda a, b, c: a * b + c,
    "power": lambda a, b, c: a**b if a > 0.0 else 0.0,
    "exponent": lambda a, b, c: math.exp(a),
    "maximum": lambda a, b, c: max(a, b),
    "minimum": lambda a, b, c: min(a, b),
}


def _values(value: Op | float | Triple, at: Point) -> Values:
    """Of an operation at a place, by channel."""
    if not isinstance(value, Op):
        return value if isinstance(value, tuple) else (value,)
    if value.name == "geometry" and value.modes[0] == "position":
        return at
    inputs = [_values(item, at) for item in value.inputs]
    mode = value.modes[0] if value.modes else ""
    if value.name == "math" and mode in _MATH:
        result = _MATH[mode](inputs[0][0], inputs[1][0], inputs[2][0])
        return (min(max(result, 0.0), 1.0) if value.modes[1] == "clamped" else result,)
    if value.name == "vector_math" and mode == "scale":
        return tuple(v * inputs[3][0] for v in inputs[0])
    if value.name == "vector_math" and mode in _MATH:
        return tuple(_MATH[mode](a, b, c) for a, b, c in zip(*inputs[:3], strict=True))
    if value.name == "separate":
        return (inputs[0]["xyz".index(mode)],)
    if value.name == "combine":
        return tuple(item[0] for item in inputs)
    if value.name == "splat":
        return inputs[0] * 3
    if value.name == "dot":
        return (sum(a * b for a, b in zip(inputs[0], inputs[1], strict=True)),)
    if value.name == "clamp":
        return (min(max(inputs[0][0], inputs[1][0]), inputs[2][0]),)
    raise _UnknownOperationError
