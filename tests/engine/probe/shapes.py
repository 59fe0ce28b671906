# SPDX-License-Identifier: GPL-3.0-or-later
"""Shapes of lights."""

import ctypes
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tests.engine.probe.call import Array, call, empty, f32, f64

SPHERE, RECTANGLE, ELLIPSE, TRIANGLE, SUN = range(5)


class Directions(NamedTuple):
    wi: Array
    distance: Array
    pdf: Array
    found: Array


def _shape(shape: ArrayLike) -> Array:
    flat = np.zeros(9)
    values = f64(shape).ravel()
    flat[: len(values)] = values
    return flat


def sample(kind: int, shape: ArrayLike, u: Array) -> Directions:
    """shape: 9 numbers, see engine/probe/shapes_probe.cpp (fewer are filled up)."""
    n = len(u)
    wi, distance, pdf, found = empty(n, 3), empty(n), empty(n), empty(n, kind=np.int32)
    call("probe_shape_sample", kind, _shape(shape), u, np.uint64(n), wi, distance, pdf, found)
    return Directions(wi, distance, pdf, found.astype(bool))


def pdf(kind: int, shape: ArrayLike, wi: ArrayLike) -> Array:
    directions = f32(wi)
    pdf = empty(len(directions))
    call("probe_shape_pdf", kind, _shape(shape), directions, np.uint64(len(directions)), pdf)
    return pdf


def solid_angle(rectangle: ArrayLike) -> float:
    return float(call("probe_solid_angle", _shape(rectangle), returns=ctypes.c_double))


def sun_projected_solid_angle(sun: ArrayLike) -> float:
    return float(call("probe_sun_projected_solid_angle", _shape(sun), returns=ctypes.c_double))
