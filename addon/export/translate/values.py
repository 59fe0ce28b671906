# SPDX-License-Identifier: GPL-3.0-or-later
"""Values of sockets: constants, or operations of a shader program."""

from __future__ import annotations

from ...scene.program import Op, Rgb

Number = float | Op
Triple = Rgb | Op
Value = tuple[float, ...] | Op  # (v,) or (r, g, b)

ZERO: Rgb = (0.0, 0.0, 0.0)


def op(name: str, *inputs: Number | Triple, modes: tuple[str, ...] = (), resource: object = None) -> Op:
    return Op(name, inputs, modes, resource)  # type: ignore[arg-type]


def number(value: Value) -> Number:
    """Of a socket of one number."""
    if isinstance(value, Op):
        return value if value.is_number else op("luminance", value)
    return value[0] if len(value) == 1 else 0.2126729 * value[0] + 0.7151522 * value[1] + 0.0721750 * value[2]


def triple(value: Value) -> Triple:
    """Of a vector or colour; a number is repeated."""
    if isinstance(value, Op):
        return op("splat", value) if value.is_number else value
    return (value[0], value[0], value[0]) if len(value) == 1 else (value[0], value[1], value[2])


def value_of(item: Number | Triple) -> Value:
    return (float(item),) if isinstance(item, (int, float)) else item


def converted(value: Value, given: str, wanted: str) -> Value:
    """As Blender makes the value of one kind of socket that of another."""
    numbers = ("VALUE", "INT", "BOOLEAN")
    if wanted in numbers and given not in numbers:
        if given == "RGBA":
            return value_of(number(value))
        if isinstance(value, Op):
            return value if value.is_number else op("average", value)
        return (sum(value) / len(value),)
    if wanted not in numbers and given in numbers:
        return triple(value)
    return value


def math(operation: str, a: Number, b: Number = 0.0, c: Number = 0.0, clamped: bool = False) -> Number:
    return op("math", a, b, c, modes=(operation, "clamped" if clamped else "free"))


def vector_math(operation: str, a: Triple, b: Triple = (0.0,) * 3, c: Triple = (0.0,) * 3, scale: Number = 1.0) -> Op:
    return op("vector_math", a, b, c, scale, modes=(operation,))


def scaled(a: Triple, factor: Number) -> Triple:
    """Of every channel."""
    if isinstance(a, Op) or isinstance(factor, Op):
        if factor == 0.0 or a == ZERO:
            return ZERO
        return a if factor == 1.0 else vector_math("scale", a, scale=factor)
    return (a[0] * factor, a[1] * factor, a[2] * factor)


def product(a: Number, b: Number) -> Number:
    if isinstance(a, Op) or isinstance(b, Op):
        return b if a == 1.0 else a if b == 1.0 else 0.0 if a == 0.0 or b == 0.0 else math("multiply", a, b)
    return a * b


def difference(a: Number, b: Number) -> Number:
    if isinstance(a, Op) or isinstance(b, Op):
        return math("subtract", a, b)
    return a - b


def added(a: Triple, b: Triple) -> Triple:
    if isinstance(a, Op) or isinstance(b, Op):
        return b if a == ZERO else a if b == ZERO else vector_math("add", a, b)
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def lerp(a: Triple, b: Triple, t: Number) -> Triple:
    """a + (b - a) t."""
    if isinstance(t, Op) or isinstance(a, Op) or isinstance(b, Op):
        return a if t == 0.0 or a == b else b if t == 1.0 else op("blend", t, a, b, modes=("mix", "free"))
    return (a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t, a[2] + (b[2] - a[2]) * t)


def clamped(a: Number, low: float = 0.0, high: float = 1.0) -> Number:
    return op("clamp", a, low, high, modes=("minmax",)) if isinstance(a, Op) else min(max(a, low), high)


def clamped_color(a: Triple, low: float = 0.0, high: float = 1.0) -> Triple:
    """What the engine cuts to the range of a parameter by itself needs none of this."""
    if isinstance(a, Op):
        return vector_math("minimum", vector_math("maximum", a, (low,) * 3), (high,) * 3)
    return (min(max(a[0], low), high), min(max(a[1], low), high), min(max(a[2], low), high))


def multiplied(a: Triple, b: Triple) -> Triple:
    """Channel by channel."""
    if isinstance(a, Op) or isinstance(b, Op):
        if ZERO in (a, b):
            return ZERO
        white = (1.0, 1.0, 1.0)
        return b if a == white else a if b == white else vector_math("multiply", a, b)
    return (a[0] * b[0], a[1] * b[1], a[2] * b[2])


def weighted(a: Triple, weights: Rgb) -> Number:
    """The sum of the channels, each times its weight."""
    if isinstance(a, Op):
        return op("dot", weights, a)
    return a[0] * weights[0] + a[1] * weights[1] + a[2] * weights[2]


def square_root(a: Triple) -> Triple:
    """Channel by channel."""
    if isinstance(a, Op):
        return op("combine", *(math("sqrt", op("separate", a, modes=(axis,))) for axis in "xyz"))
    return (max(a[0], 0.0) ** 0.5, max(a[1], 0.0) ** 0.5, max(a[2], 0.0) ** 0.5)


def squared(a: Number) -> Number:
    return math("multiply", a, a) if isinstance(a, Op) else a * a
