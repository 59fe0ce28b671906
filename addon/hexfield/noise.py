# SPDX-License-Identifier: GPL-3.0-or-later
"""Repeatable randomness by place: the same whatever the order, the machine or the version of numpy."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Sloped = tuple[Floats, Floats, Floats]  # a height and its derivatives by x and by y, each (n)


def random_unit(a: Integers, b: Integers, seed: int, stream: int) -> Floats:
    """Uniform in [0, 1), one number for each pair of integers (a, b), seed and stream.

    A chain of the 32-bit finaliser `lowbias32` (Wellons 2018, "Prospecting for hash functions").
    """
    state = np.full(np.broadcast(a, b).shape, (seed * 0x9E3779B9 + stream * 0x85EBCA6B) & 0xFFFFFFFF, dtype=np.uint32)
    for word in (np.asarray(a), np.asarray(b)):
        state = _mix(state ^ _mix(word.astype(np.int64).astype(np.uint32) + np.uint32(0x9E3779B9)))
    return state.astype(np.float64) * 2.0**-32


def _mix(x: NDArray[np.uint32]) -> NDArray[np.uint32]:
    x = x ^ (x >> np.uint32(16))
    x *= np.uint32(0x7FEB352D)
    x ^= x >> np.uint32(15)
    x *= np.uint32(0x846CA68B)
    x ^= x >> np.uint32(16)
    return x


def hills(x: Floats, y: Floats, wavelength: float, octaves: int, seed: int, kind: str = "SMOOTH") -> Sloped:
    """Sum of `octaves` layers of gradient noise, each of half the size and weight of the one before, and its slopes.

    x, y: (n). kind: SMOOTH, RIDGED or BILLOWED, which a layer's noise is bent to before the layers are added. Returns
    height in [-1, 1] and its derivatives by x and by y, each (n). Every layer is turned against the one before, so that
    their lattices, where gradient noise is 0, do not line up.
    """
    height, slope_x, slope_y = np.zeros_like(x), np.zeros_like(x), np.zeros_like(x)
    weight_sum = 2.0 - 2.0 ** (1 - octaves)
    for octave in range(octaves):
        frequency = 2.0**octave / wavelength
        weight = 0.5**octave / weight_sum
        angle = 0.5 + 2.4 * octave
        c, s = np.cos(angle) * frequency, np.sin(angle) * frequency
        value, du, dv = _gradient_noise(c * x - s * y, s * x + c * y, seed, stream=1000 + octave)
        if kind != "SMOOTH":
            value, du, dv = _bend(value, du, dv, kind)
        height += weight * value
        slope_x += weight * (du * c + dv * s)
        slope_y += weight * (dv * c - du * s)
    return height, slope_x, slope_y


def _bend(value: Floats, du: Floats, dv: Floats, kind: str) -> Sloped:
    """Noise in [-1, 1] with a crease where it was 0: a ridge on top, or a furrow between domes."""
    if kind == "RIDGED":
        rest = 1.0 - np.abs(value)
        steep = -4.0 * rest * np.sign(value)
        return 2.0 * rest * rest - 1.0, steep * du, steep * dv
    steep = 2.0 * np.sign(value)
    return 2.0 * np.abs(value) - 1.0, steep * du, steep * dv


def _gradient_noise(u: Floats, v: Floats, seed: int, stream: int) -> Sloped:
    """Perlin's gradient noise with unit gradients and the quintic fade (Perlin 2002), scaled by sqrt(2) to fill [-1,
    1].
    """
    cell_u, cell_v = np.floor(u), np.floor(v)
    u0, v0 = u - cell_u, v - cell_v
    u1, v1 = u0 - 1.0, v0 - 1.0
    fade_u, fade_v = (f * f * f * (f * (6 * f - 15) + 10) for f in (u0, v0))
    gradients = _corner_gradients(cell_u.astype(np.int64), cell_v.astype(np.int64), seed, stream)
    (gu00, gv00), (gu10, gv10), (gu01, gv01), (gu11, gv11) = gradients
    low, high = gu00 * u0 + gv00 * v0, gu01 * u0 + gv01 * v1
    low_rise, high_rise = gu10 * u1 + gv10 * v0 - low, gu11 * u1 + gv11 * v1 - high
    low += fade_u * low_rise
    high += fade_u * high_rise
    rise = high - low
    value = low + fade_v * rise
    du = _bilinear(gu00, gu10, gu01, gu11, fade_u, fade_v)
    du += 30 * (u0 * u1) ** 2 * (low_rise + fade_v * (high_rise - low_rise))
    dv = _bilinear(gv00, gv10, gv01, gv11, fade_u, fade_v)
    dv += 30 * (v0 * v1) ** 2 * rise
    root = np.sqrt(2.0)
    return root * value, root * du, root * dv


def _bilinear(a00: Floats, a10: Floats, a01: Floats, a11: Floats, s: Floats, t: Floats) -> Floats:
    low, high = a00 + s * (a10 - a00), a01 + s * (a11 - a01)
    low += t * (high - low)
    return low


def _corner_gradients(i: Integers, j: Integers, seed: int, stream: int) -> list[tuple[Floats, Floats]]:
    """The unit gradients at the four corners of cells (i, j): 00, 10, 01, 11. Where fewer lattice points than cells are
    asked for, each is made once."""
    corners = ((0, 0), (1, 0), (0, 1), (1, 1))
    if len(i) == 0:
        return [(np.zeros(0), np.zeros(0)) for _ in corners]
    first_i, first_j = int(i.min()), int(j.min())
    rows, columns = int(i.max()) - first_i + 2, int(j.max()) - first_j + 2
    if rows * columns > len(i):
        return [_gradients(i + a, j + b, seed, stream) for a, b in corners]
    lattice = np.arange(rows * columns)
    gu, gv = _gradients(first_i + lattice // columns, first_j + lattice % columns, seed, stream)
    at = (i - first_i) * columns + (j - first_j)
    return [(gu[at + a * columns + b], gv[at + a * columns + b]) for a, b in corners]


def _gradients(i: Integers, j: Integers, seed: int, stream: int) -> tuple[Floats, Floats]:
    angle = 2 * np.pi * random_unit(i, j, seed, stream)
    return np.cos(angle), np.sin(angle)
