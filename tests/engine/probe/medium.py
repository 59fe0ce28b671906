# SPDX-License-Identifier: GPL-3.0-or-later
"""Distances in a medium: transmittance, free flights, equiangular ones."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tests.engine.probe.call import Array, call, empty, f32


def _sigma(absorption: ArrayLike, scattering: ArrayLike) -> Array:
    return np.ascontiguousarray(np.stack([f32(absorption, 3), f32(scattering, 3)]))


def transmittance(absorption: ArrayLike, scattering: ArrayLike, t: ArrayLike) -> Array:
    distances = f32(t)
    out = empty(len(distances), 3)
    call("probe_transmittance", _sigma(absorption, scattering), distances, np.uint64(len(distances)), out)
    return out


class Flights(NamedTuple):
    t: Array
    scattered: Array
    weight: Array
    pdf: Array


def free_flight(
    absorption: ArrayLike,
    scattering: ArrayLike,
    beta: ArrayLike,
    t_max: float,
    u: Array,
    bits: Array,
    own: bool = False,
) -> Flights:
    """own: numbers from Sampler(bits[i], 0, 0, 0, 0) in place of u and bits."""
    n = len(bits)
    t, scattered, weight, pdf = empty(n), empty(n, kind=np.int32), empty(n, 3), empty(n)
    sigma, coarse = _sigma(absorption, scattering), np.ascontiguousarray(u)
    call(
        "probe_free_flight", sigma, f32(beta, 3), np.float32(t_max), coarse, bits, int(own), np.uint64(n),
        t, scattered, weight, pdf,
    )  # fmt: skip
    return Flights(t, scattered.astype(bool), weight, pdf)


def free_flight_pdf(absorption: ArrayLike, scattering: ArrayLike, beta: ArrayLike, t: ArrayLike) -> Array:
    distances = f32(t)
    pdf = empty(len(distances))
    sigma = _sigma(absorption, scattering)
    call("probe_free_flight_pdf", sigma, f32(beta, 3), distances, np.uint64(len(distances)), pdf)
    return pdf


class Collisions(NamedTuple):
    t: Array
    weight: Array
    pdf: Array


def collision(
    absorption: ArrayLike,
    scattering: ArrayLike,
    beta: ArrayLike,
    t_max: float,
    u: Array,
    bits: Array,
    own: bool = False,
) -> Collisions:
    n = len(bits)
    out = Collisions(empty(n), empty(n, 3), empty(n))
    sigma, coarse = _sigma(absorption, scattering), np.ascontiguousarray(u)
    call("probe_collision", sigma, f32(beta, 3), np.float32(t_max), coarse, bits, int(own), np.uint64(n), *out)
    return out


def collision_pdf(absorption: ArrayLike, scattering: ArrayLike, beta: ArrayLike, t_max: float, t: ArrayLike) -> Array:
    distances = f32(t)
    pdf = empty(len(distances))
    sigma, n = _sigma(absorption, scattering), np.uint64(len(distances))
    call("probe_collision_pdf", sigma, f32(beta, 3), np.float32(t_max), distances, n, pdf)
    return pdf


def equiangular(a: float, b: float, h: float, u: ArrayLike) -> Array:
    numbers = f32(u)
    t = empty(len(numbers))
    call("probe_equiangular", np.float32(a), np.float32(b), np.float32(h), numbers, np.uint64(len(numbers)), t)
    return t


def equiangular_pdf(a: float, b: float, h: float, t: ArrayLike) -> Array:
    distances = f32(t)
    pdf = empty(len(distances))
    call(
        "probe_equiangular_pdf", np.float32(a), np.float32(b), np.float32(h), distances, np.uint64(len(distances)), pdf
    )
    return pdf
