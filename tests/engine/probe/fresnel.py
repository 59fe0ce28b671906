# SPDX-License-Identifier: GPL-3.0-or-later
"""Fresnel functions, the distribution of normals, smooth glass."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tests.engine.probe.call import Array, call, empty, f32


def _fresnel(kind: int, cos_i: ArrayLike, eta: ArrayLike, k: ArrayLike = 0) -> Array:
    c, e, extinction = (f32(a) for a in np.broadcast_arrays(*map(np.atleast_1d, (cos_i, eta, k))))
    out = empty(len(c))
    call("probe_fresnel", kind, c, e, extinction, np.uint64(len(c)), out)
    return out


def conductor(cos_i: ArrayLike, eta: ArrayLike, k: ArrayLike) -> Array:
    return _fresnel(0, cos_i, eta, k)


def dielectric(cos_i: ArrayLike, eta: ArrayLike) -> Array:
    return _fresnel(1, cos_i, eta)


def schlick(cos_i: ArrayLike, f0: ArrayLike, f90: ArrayLike = 1) -> Array:
    return _fresnel(2, cos_i, f0, f90)


def dielectric_schlick(cos_i: ArrayLike, eta: ArrayLike) -> Array:
    return _fresnel(3, cos_i, eta)


def ggx_d(h: ArrayLike, alpha: float) -> Array:
    normals = f32(h)
    out = empty(len(normals))
    call("probe_ggx_d", normals, np.float32(alpha), np.uint64(len(normals)), out)
    return out


class GlassSamples(NamedTuple):
    wi: Array
    weight: Array
    probability: Array
    transmitted: Array


def glass(wo: ArrayLike, eta: ArrayLike, u: ArrayLike, schlick: bool = False) -> GlassSamples:
    directions = f32(wo)
    n = len(directions)
    out = GlassSamples(empty(n, 3), empty(n, 3), empty(n), empty(n, kind=np.int32))
    call("probe_glass", directions, f32(eta, n), int(schlick), f32(u, n), np.uint64(n), *out)
    return out
