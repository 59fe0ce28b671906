# SPDX-License-Identifier: GPL-3.0-or-later
"""What a program gives at most: the bounds hold, and are reached, where there are any."""

from math import inf

import numpy as np
import pytest

from addon.export.translate.bounds import UNKNOWN, interval
from addon.export.translate.values import lerp, math, op, scaled, vector_math
from addon.scene.program import Op, Table, Texture

NOISE = op("noise_color", (0.0, 0.0, 0.0), *(0.0,) * 7, modes=("3d", "fbm", "raw", "before_4"))
FACTOR = math("multiply", 0.0, op("noise", (0.0, 0.0, 0.0), *(0.0,) * 7), clamped=True)


def ramp(*rows: tuple[float, float, float]) -> Op:
    colors = np.array([(*row, 5.0) for row in rows], np.float32)
    return op("ramp", FACTOR, modes=("linear",), resource=Table(colors))


def image(kind: type[np.generic]) -> Op:
    return op("image", NOISE, 0.0, resource=Texture("", np.ones((1, 1, 4), kind)))


RAMP = ramp((0.5, 0.25, 0.0), (0.0, 1.0, 0.0))


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        (0.5, (0.5, 0.5)),
        ((0.5, 4.0, -1.0), (-1.0, 4.0)),
        (NOISE, UNKNOWN),
        (FACTOR, (0.0, 1.0)),
        (RAMP, (0.0, 1.0)),
        (vector_math("multiply", RAMP, (4.0, 3.0, 2.0)), (0.0, 4.0)),
        (vector_math("multiply", RAMP, (-4.0, 3.0, 2.0)), (-4.0, 3.0)),
        (vector_math("multiply", NOISE, (4.0, 3.0, 2.0)), UNKNOWN),
        (vector_math("minimum", NOISE, (4.0, 3.0, 2.0)), (-inf, 4.0)),
        (vector_math("subtract", RAMP, (1.0, 1.0, 0.5)), (-1.0, 0.5)),
        (scaled(RAMP, 3.0), (0.0, 3.0)),
        (lerp(RAMP, (2.0, 2.0, 1.5), FACTOR), (0.0, 2.0)),
        (lerp(RAMP, (2.0, 2.0, 1.5), 1.5), UNKNOWN),
        (op("clamp", NOISE, 0.0, 0.5, modes=("minmax",)), (0.0, 0.5)),
        (op("clamp", FACTOR, 0.25, 3.0, modes=("minmax",)), (0.25, 1.0)),
        (op("combine", FACTOR, 2.0, 0.0), (0.0, 2.0)),
        (image(np.uint8), (0.0, 1.0)),
        (image(np.float32), UNKNOWN),
    ],
)
def test_bounds(value: object, expected: tuple[float, float]) -> None:
    assert interval(value) == expected  # type: ignore[arg-type]


def test_a_deep_graph_has_bounds() -> None:
    value: Op = RAMP
    for _ in range(5000):
        value = vector_math("add", value, (0.0, 0.0, 0.0))
    assert interval(value) == (0.0, 1.0)
