# SPDX-License-Identifier: GPL-3.0-or-later
"""Functions on sixteen lanes: connections to light vertices, nodes of equiangular tables; and such a table."""

import ctypes
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tests.engine.probe.call import Array, call, empty, f32, f64

LANES = NODES = 16


def has_avx512() -> bool:
    return bool(call("probe_has_avx512", returns=ctypes.c_int))


class Connections(NamedTuple):
    means: Array  # (n)
    sums: Array  # (20): r, g, b, mean of them, that by lane


def connect(wide: bool, medium: ArrayLike, vertices: ArrayLike, point: ArrayLike, clamp_distance: float) -> Connections:
    """medium (4): extinction by channel, g. vertices (6 or 9, n): position, power, flight. point (6): place, view."""
    v = f32(vertices)
    n = v.shape[1]
    means, sums = empty(n), empty(4 + LANES)
    call(
        *("probe_connect", int(wide), f32(medium), v, int(len(v) == 9), np.uint64(n), f32(point)),
        *(np.float32(clamp_distance), means, sums),
    )
    return Connections(means, sums)


def pick_targets(wide: bool, medium: ArrayLike, vertices: ArrayLike, points: ArrayLike, clamp_distance: float) -> Array:
    """points (m, 6); returns targets (n)."""
    v, p = f32(vertices), f32(points)
    n = v.shape[1]
    targets = empty(n)
    call(
        *("probe_pick_targets", int(wide), f32(medium), v, int(len(v) == 9), np.uint64(n), p, np.uint64(len(p))),
        *(np.float32(clamp_distance), targets),
    )
    return targets


def equiangular_nodes(wide: bool, medium: ArrayLike, shape: ArrayLike) -> Array:
    """shape (8): t_foot, h, h2, radius, distance, cut, x_first, x_step. Returns the density (16), the last source."""
    density = empty(NODES + 1)
    call("probe_equiangular_nodes", int(wide), f32(medium), f64(shape), density)
    return density


class DistanceSamples(NamedTuple):
    t: Array
    pdf: Array


def equiangular_table(
    sigma: ArrayLike, g: float, segment: ArrayLike, light: ArrayLike, u: ArrayLike
) -> DistanceSamples:
    """sigma (2, 3): absorption, scattering. segment (7): origin, direction, end. light (4): centre, radius."""
    numbers = f32(u)
    t, pdf = empty(len(numbers)), empty(len(numbers))
    call(
        *("probe_equiangular_table", f32(sigma), np.float32(g), f32(segment), f32(light)),
        *(numbers, np.uint64(len(numbers)), t, pdf),
    )
    return DistanceSamples(t, pdf)


def equiangular_pdf(sigma: ArrayLike, g: float, segment: ArrayLike, light: ArrayLike, t: ArrayLike) -> Array:
    at = f32(t)
    pdf = empty(len(at))
    call(
        *("probe_equiangular_table_pdf", f32(sigma), np.float32(g), f32(segment), f32(light)),
        *(at, np.uint64(len(at)), pdf),
    )
    return pdf
