# SPDX-License-Identifier: GPL-3.0-or-later
"""Repeatable randomness by place: the same whatever the order, the machine or the version of numpy."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


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
    x = x * np.uint32(0x7FEB352D)
    x = x ^ (x >> np.uint32(15))
    x = x * np.uint32(0x846CA68B)
    return x ^ (x >> np.uint32(16))


def hills(x: Floats, y: Floats, wavelength: float, octaves: int, seed: int) -> tuple[Floats, Floats, Floats]:
    """Sum of `octaves` layers of gradient noise, each of half the size and weight of the one before, and its slopes.

    x, y: (n). Returns height in [-1, 1] and its derivatives by x and by y, each (n). Every layer is turned against
    the one before, so that their lattices, where gradient noise is 0, do not line up.
    """
    height, slope_x, slope_y = np.zeros_like(x), np.zeros_like(x), np.zeros_like(x)
    weight_sum = 2.0 - 2.0 ** (1 - octaves)
    for octave in range(octaves):
        frequency = 2.0**octave / wavelength
        weight = 0.5**octave / weight_sum
        angle = 0.5 + 2.4 * octave
        c, s = np.cos(angle) * frequency, np.sin(angle) * frequency
        value, du, dv = _gradient_noise(c * x - s * y, s * x + c * y, seed, stream=1000 + octave)
        height += weight * value
        slope_x += weight * (du * c + dv * s)
        slope_y += weight * (dv * c - du * s)
    return height, slope_x, slope_y


def _gradient_noise(u: Floats, v: Floats, seed: int, stream: int) -> tuple[Floats, Floats, Floats]:
    """Perlin's gradient noise with unit gradients and the quintic fade (Perlin 2002), scaled by sqrt(2) to fill [-1,
    1].
    """
    cell_u, cell_v = np.floor(u), np.floor(v)
    fu, fv = u - cell_u, v - cell_v
    i, j = cell_u.astype(np.int64), cell_v.astype(np.int64)
    fade_u, fade_v = fu**3 * (fu * (6 * fu - 15) + 10), fv**3 * (fv * (6 * fv - 15) + 10)
    fade_du, fade_dv = 30 * (fu * (fu - 1)) ** 2, 30 * (fv * (fv - 1)) ** 2
    value, du, dv = np.zeros_like(u), np.zeros_like(u), np.zeros_like(u)
    for corner_u in (0, 1):
        for corner_v in (0, 1):
            angle = 2 * np.pi * random_unit(i + corner_u, j + corner_v, seed, stream)
            gu, gv = np.cos(angle), np.sin(angle)
            dot = gu * (fu - corner_u) + gv * (fv - corner_v)
            wu, dwu = (fade_u, fade_du) if corner_u else (1 - fade_u, -fade_du)
            wv, dwv = (fade_v, fade_dv) if corner_v else (1 - fade_v, -fade_dv)
            value += wu * wv * dot
            du += wv * (dwu * dot + wu * gu)
            dv += wu * (dwv * dot + wv * gv)
    root = np.sqrt(2.0)
    return root * value, root * du, root * dv
