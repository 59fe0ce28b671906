# SPDX-License-Identifier: GPL-3.0-or-later
"""Random numbers, warps and discrete distributions."""

import ctypes
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tests.engine.probe.call import Array, call, empty, f32, f64

UNIFORM_SPHERE, COSINE_HEMISPHERE, CONE, DISK, TRIANGLE_BARYCENTRICS = range(5)


def uniform(seed: int, n: int) -> Array:
    """(n, 2) float32 multiples of 2^-24 in [0, 1), as the engine's own."""
    bits = np.random.default_rng(seed).integers(0, 1 << 24, (n, 2))
    return (bits * 2.0**-24).astype(np.float32)


def random_bits(seed: int, n: int) -> Array:
    """(n) uint64."""
    return np.random.default_rng(seed).integers(0, 1 << 64, n, np.uint64)


def mix64(x: int) -> int:
    return int(call("probe_mix64", np.uint64(x), returns=ctypes.c_uint64))


def hash64(a: int, b: int) -> int:
    return int(call("probe_hash64", np.uint64(a), np.uint64(b), returns=ctypes.c_uint64))


class Numbers(NamedTuple):
    next_1d: Array
    next_2d: Array
    next_exponential: Array
    next_bits: Array
    stratified_1d: Array
    stratified_2d: Array
    stratified_bits: Array


def sampler(
    seed: int, x: ArrayLike, y: ArrayLike, replicate: ArrayLike, index: ArrayLike, *, skip: int = 0, stratum: int = 0
) -> Numbers:
    """What Samplers of these keys (broadcast) give after `skip` numbers, each drawn from its own copy."""
    keys = [
        np.ascontiguousarray(k, np.uint32) for k in np.broadcast_arrays(*map(np.atleast_1d, (x, y, replicate, index)))
    ]
    n = len(keys[0])
    bits = [empty(n, kind=np.uint64) for _ in range(2)]
    out = Numbers(empty(n), empty(n, 2), empty(n), bits[0], empty(n), empty(n, 2), bits[1])
    call("probe_sampler", np.uint64(seed), *keys, np.uint64(n), skip, stratum, *out)
    return out


def next_bool(seed: int, probability: float, n: int) -> int:
    """How often of n times it is true."""
    return int(call("probe_next_bool", np.uint64(seed), np.float32(probability), np.uint64(n), returns=ctypes.c_uint64))


def exponential(bits: Array, tau: float | None = None) -> Array:
    out = empty(len(bits))
    if tau is None:
        call("probe_exponential", bits, np.uint64(len(bits)), out)
    else:
        call("probe_truncated_exponential", bits, np.float32(tau), np.uint64(len(bits)), out)
    return out


def warp(kind: int, u: Array, parameter: float = 0) -> tuple[Array, Array]:
    """Points (n, 3) and densities (n)."""
    out, pdf = empty(len(u), 3), empty(len(u))
    call("probe_warp", kind, np.float32(parameter), u, np.uint64(len(u)), out, pdf)
    return out, pdf


def one_minus_cos(s: float) -> float:
    return float(call("probe_one_minus_cos", np.float32(s), returns=ctypes.c_float))


def alias_table(weights: ArrayLike, u: Array) -> tuple[Array, Array, Array, Array] | None:
    """Indices (n), their pmf (n), the pmf of every entry, the rest of the number (n); None for an empty table."""
    w, n = f64(weights), len(u)
    index, pmf, every, rest = empty(n, kind=np.uint32), empty(n), empty(len(w)), empty(n)
    coarse, fine = np.ascontiguousarray(u[:, 0]), np.ascontiguousarray(u[:, 1])
    found = call(
        "probe_alias_table",
        w,
        np.uint64(len(w)),
        coarse,
        fine,
        np.uint64(n),
        index,
        pmf,
        every,
        rest,
        returns=ctypes.c_int,
    )
    return (index, pmf, every, rest) if found else None


def distribution_2d(weights: ArrayLike, u: Array) -> tuple[Array, Array, Array, Array] | None:
    """uv (n, 2), pdf of the sample, pdf by its twin, and the pdf of every texel; None for an empty distribution."""
    w, n = f32(weights), len(u)
    uv, pdf, twin, texels = empty(n, 2), empty(n), empty(n), empty(*w.shape)
    found = call(
        "probe_distribution_2d", w, np.uint64(w.shape[1]), np.uint64(w.shape[0]), u, np.uint64(n),
        uv, pdf, twin, texels, returns=ctypes.c_int,
    )  # fmt: skip
    return (uv, pdf, twin, texels) if found else None
