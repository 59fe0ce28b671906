# SPDX-License-Identifier: GPL-3.0-or-later
"""Loops over vertices and nodes, and the table of a line."""

import ctypes
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tests.engine.probe.call import Array, call, empty, f32, f64

LANES = NODES = 16


def has_avx512() -> bool:
    return bool(call("probe_has_avx512", returns=ctypes.c_int))


class Connections(NamedTuple):
    parts: Array  # (n)
    sums: Array  # (20): r, g, b, mean of them, that by lane


def connect(wide: bool, medium: ArrayLike, vertices: ArrayLike, point: ArrayLike, bound: float) -> Connections:
    """medium (4): extinction by channel, g. vertices (6 or 9, n): position, power, flight. point (6): place, view."""
    v = f32(vertices)
    n = v.shape[1]
    parts, sums = empty(n), empty(4 + LANES)
    call(
        *("probe_connect", int(wide), f32(medium), v, int(len(v) == 9), np.uint64(n), f32(point)),
        *(np.float32(bound), parts, sums),
    )
    return Connections(parts, sums)


def weigh(wide: bool, medium: ArrayLike, vertices: ArrayLike, points: ArrayLike, soften: float) -> Array:
    """points (m, 6); returns targets (n)."""
    v, p = f32(vertices), f32(points)
    n = v.shape[1]
    targets = empty(n)
    call(
        *("probe_weigh", int(wide), f32(medium), v, int(len(v) == 9), np.uint64(n), p, np.uint64(len(p))),
        *(np.float32(soften), targets),
    )
    return targets


def line_nodes(wide: bool, medium: ArrayLike, shape: ArrayLike) -> Array:
    """shape (8): t_foot, h, h2, radius, distance, cut, x_first, x_step. Returns the density (16), the last source."""
    density = empty(NODES + 1)
    call("probe_line_nodes", int(wide), f32(medium), f64(shape), density)
    return density


class LineSamples(NamedTuple):
    t: Array
    pdf: Array


def line(sigma: ArrayLike, g: float, segment: ArrayLike, light: ArrayLike, u: ArrayLike) -> LineSamples:
    """sigma (2, 3): absorption, scattering. segment (7): origin, direction, end. light (4): centre, radius."""
    numbers = f32(u)
    t, pdf = empty(len(numbers)), empty(len(numbers))
    call(
        *("probe_line", f32(sigma), np.float32(g), f32(segment), f32(light), numbers, np.uint64(len(numbers))),
        *(t, pdf),
    )
    return LineSamples(t, pdf)


def line_pdf(sigma: ArrayLike, g: float, segment: ArrayLike, light: ArrayLike, t: ArrayLike) -> Array:
    at = f32(t)
    pdf = empty(len(at))
    call(
        *("probe_line_pdf", f32(sigma), np.float32(g), f32(segment), f32(light), at, np.uint64(len(at)), pdf),
    )
    return pdf
