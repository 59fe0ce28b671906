# SPDX-License-Identifier: GPL-3.0-or-later
"""IES Texture: how bright a lamp is by direction, from a file of photometric data (IES LM-63), as a picture that a
program looks up."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import pi
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...scene.program import Texture
from .surface import geometry
from .values import Triple, Value, math, op, product, triple, value_of, vector_math

if TYPE_CHECKING:
    from ..nodes import Nodes
    from ..sockets import Source

Array = NDArray[np.float64]

UNREADABLE = 100.0  # what Cycles shows where a file cannot be read
WATTS = 0.0706650768394  # 4 pi candela at 177.83 lumen a watt
ROWS, COLUMNS = 1024, 512  # of the picture: angles to the axis, angles around it
MOST_ANGLES = 10_000


@dataclass(frozen=True)
class Photometry:
    down: Array  # (m) degrees from straight down
    around: Array  # (n) degrees about the axis, from 0 to 360
    watts: Array  # (n, m)


def parse(text: str) -> Photometry:
    """Raises ValueError with the reason."""
    _, mark, rest = text.partition("TILT=")
    if not mark:
        raise ValueError("it has no TILT=")
    kind, _, rest = rest.partition("\n")
    words = rest.replace(",", " ").split()
    try:
        values = [float(word) for word in words]
    except ValueError as error:
        raise ValueError(f"a number was expected: {error}") from None
    if kind.strip() == "INCLUDE" and len(values) > 1:
        values = values[2 + 2 * _whole(values[1]) :]
    if len(values) < 13:
        raise ValueError("it ends too early")
    factor = values[2] * values[10] * values[11] * WATTS
    m, n, photometric_type = (_whole(value) for value in values[3:6])
    if not (2 <= m <= MOST_ANGLES and 1 <= n <= MOST_ANGLES):
        raise ValueError(f"it has {m} and {n} angles; allowed: 2 to {MOST_ANGLES} and 1 to {MOST_ANGLES}")
    table = np.array(values[13:], np.float64)
    if len(table) < m + n + m * n:
        raise ValueError("it ends too early")
    if photometric_type != 1:
        raise ValueError("it is of type A or B; allowed: type C")
    down, around, watts = table[:m], table[m : m + n], table[m + n : m + n + m * n].reshape(n, m) * factor
    if not np.isfinite(table).all() or (np.diff(down) <= 0.0).any() or (np.diff(around) <= 0.0).any():
        raise ValueError("its angles do not rise")
    return Photometry(down, *_all_around(around, watts))


def _whole(value: float) -> int:
    if not 0.0 <= value <= 1e9 or value != int(value):
        raise ValueError(f"a whole number was expected: {value:g}")
    return int(value)


def _all_around(around: Array, watts: Array) -> tuple[Array, Array]:
    """Of a file that holds a quarter or a half of what is symmetric, or one half plane of what is round."""
    if around[0] == 90.0:
        around = around - 90.0
    if around[0] != 0.0:
        raise ValueError("its angles about the axis do not begin at 0")
    if len(around) == 1:
        return np.array([0.0, 360.0]), np.repeat(watts, 2, axis=0)
    for end in (90.0, 180.0):
        if around[-1] == end:
            around = np.concatenate([around, 2.0 * end - around[-2::-1]])
            watts = np.concatenate([watts, watts[-2::-1]])
    if around[-1] < 360.0:
        around, watts = np.append(around, 360.0), np.concatenate([watts, watts[:1]])
    return around, watts


def _cubic(a: Array, b: Array, c: Array, d: Array, x: Array) -> Array:
    """Catmull and Rom's, between b and c."""
    return 0.5 * (((d + 3.0 * (b - c) - a) * x + (2.0 * a - 5.0 * b + 4.0 * c - d)) * x + (c - a)) * x + b


def _cells(angles: Array, at: Array) -> tuple[NDArray[np.int64], Array]:
    """The interval of each of `at`, and the part of it before."""
    cell = np.clip(np.searchsorted(angles, at, side="left") - 1, 0, len(angles) - 2)
    return cell, (at - angles[cell]) / (angles[cell + 1] - angles[cell])


def picture(data: Photometry) -> NDArray[np.float32]:
    """(ROWS, COLUMNS, 1): watts, the first row straight down, the first column at 0 about the axis."""
    down = (np.arange(ROWS) + 0.5) * 180.0 / ROWS
    around = (np.arange(COLUMNS) + 0.5) * 360.0 / COLUMNS
    v, part_down = _cells(data.down, down)
    last = len(data.down) - 1
    w = data.watts
    along = _cubic(w[:, np.where(v == 0, 1, v - 1)], w[:, v], w[:, v + 1], w[:, np.minimum(v + 2, last)], part_down)
    h, part_around = _cells(data.around, around)
    count = len(data.around)
    before, after = np.where(h == 0, count - 2, h - 1), np.where(h + 2 == count, 1, h + 2)
    result = _cubic(along[before], along[h], along[h + 1], along[after], part_around[:, None]).T
    result[(down >= data.down[-1]) | (down < data.down[0])] = 0.0
    return np.maximum(result, 0.0).astype(np.float32)[..., None]


@lru_cache(maxsize=16)
def _texture(text: str) -> Texture:
    return Texture("IES", picture(parse(text)))


def ies_texture(nodes: Nodes, source: Source) -> Value:
    node = source.node
    strength = nodes.number_named(source, "Strength", 1.0)
    try:
        texture = _texture(_text(node))
    except (ValueError, OSError, IndexError) as error:
        nodes.notice(node, f"its file cannot be read ({error}); it is {UNREADABLE:g} everywhere")
        return value_of(product(strength, UNREADABLE))
    socket = node.inputs["Vector"]
    direction = _direction(nodes) if nodes.is_free(source, socket) else triple(nodes.socket_value(source, socket))
    x, y, z = (op("separate", vector_math("normalize", direction), modes=(axis,)) for axis in "xyz")
    column = math("multiply_add", math("arctan2", x, y), 0.5 / pi, 0.5)
    row = math("multiply", math("arccosine", math("multiply", z, -1.0)), 1.0 / pi)
    modes = ("flat", "linear", "extend", "as_is")
    found = op("image", op("combine", column, row, 0.0), 0.0, modes=modes, resource=texture)
    return value_of(product(strength, op("separate", found, modes=("x",))))


def _direction(nodes: Nodes) -> Triple:
    """In the lamp's own space, the way that its light goes; before Blender 4, the lamp's normal."""
    if nodes.version < (4, 0):
        return geometry(nodes, "object_normal")
    return op("vector_transform", geometry(nodes, "incoming"), modes=("vector", "world", "object"))


def _text(node: Any) -> str:
    if node.mode == "INTERNAL":
        if node.ies is None:
            raise ValueError("there is none")
        return str(node.ies.as_string())
    import bpy

    path = bpy.path.abspath(node.filepath)
    if not path:
        raise ValueError("there is none")
    return Path(path).read_text(errors="replace")
