# SPDX-License-Identifier: GPL-3.0-or-later
"""Cryptomatte (Friedman and Jones 2015): which objects take up how much of a pixel, as floats that name them by a hash.

The engine knows numbers in place of names. "rank" is what Cryptomatte calls a pair of a name and its part of the pixel.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

RANKS_A_LAYER = 2
KINDS = ("object", "material", "asset")


def murmur3(data: bytes) -> int:
    """MurmurHash3_x86_32 with seed 0 (Appleby), what Cryptomatte's specification hashes names with."""

    def rotated(value: int, bits: int) -> int:
        return (value << bits | value >> (32 - bits)) & 0xFFFFFFFF

    def mixed(block: int) -> int:
        return rotated(block * 0xCC9E2D51 & 0xFFFFFFFF, 15) * 0x1B873593 & 0xFFFFFFFF

    state, whole = 0, len(data) // 4 * 4
    for i in range(0, whole, 4):
        state ^= mixed(int.from_bytes(data[i : i + 4], "little"))
        state = (rotated(state, 13) * 5 + 0xE6546B64) & 0xFFFFFFFF
    if len(data) > whole:
        state ^= mixed(int.from_bytes(data[whole:], "little"))
    state ^= len(data)
    for shift, factor in ((16, 0x85EBCA6B), (13, 0xC2B2AE35)):
        state = (state ^ state >> shift) * factor & 0xFFFFFFFF
    return state ^ state >> 16


def as_float(hashed: int) -> float:
    """A hash as the float of its bits, kept from what is no number, infinite or denormal."""
    exponent = min(max(hashed >> 23 & 0xFF, 1), 254)
    return float(np.array([hashed & 0x807FFFFF | exponent << 23], np.uint32).view(np.float32)[0])


@dataclass(frozen=True)
class Names:
    """Of each kind, the names that the engine's numbers stand for; number 0 is nothing."""

    object: Sequence[str] = ()
    material: Sequence[str] = ()
    asset: Sequence[str] = ()

    def of(self, kind: str) -> Sequence[str]:
        names: Sequence[str] = getattr(self, kind)
        return names


Ranks = tuple[NDArray[np.float32], NDArray[np.float32]]


def ranks(pairs: NDArray[np.float32], names: Sequence[str]) -> Ranks:
    """(height, width, 2 n) pairs of the engine's numbers and parts -> hashes and parts, (height, width, m) each, the
    largest part first; m: as many as any pixel has. names: of numbers from 1 on; numbers of one name are one."""
    used = int((pairs[..., 1::2] > 0.0).any(axis=(0, 1)).sum())  # the largest stand first
    table = np.array([0.0, *(as_float(murmur3(name.encode())) for name in names)], np.float32)
    numbers = np.clip(pairs[..., 0 : 2 * used : 2].astype(np.int64), 0, len(table) - 1)
    hashes, parts = table[numbers], np.array(pairs[..., 1 : 2 * used : 2])
    if len(set(names)) < len(names):
        parts = _joined(hashes, parts)
        order = np.argsort(-parts, axis=-1, kind="stable")
        hashes, parts = (np.take_along_axis(values, order, -1) for values in (hashes, parts))
    return np.where(parts > 0.0, hashes, np.float32(0.0)), parts


def _joined(hashes: NDArray[np.float32], parts: NDArray[np.float32]) -> NDArray[np.float32]:
    """The parts of one hash at the first place of it."""
    for i in range(1, parts.shape[-1]):
        for j in range(i):
            same = (hashes[..., i] == hashes[..., j]) & (parts[..., i] > 0.0)
            parts[..., j] += np.where(same, parts[..., i], np.float32(0.0))
            parts[..., i] = np.where(same, np.float32(0.0), parts[..., i])
    return parts


def layer(of: Ranks, number: int) -> NDArray[np.float32]:
    """(height, width, 4): the ranks of one of Blender's passes."""
    hashes, parts = of
    result = np.zeros((*parts.shape[:2], 2 * RANKS_A_LAYER), np.float32)
    for i in range(RANKS_A_LAYER):
        rank = RANKS_A_LAYER * number + i
        if rank < parts.shape[-1]:
            result[..., 2 * i], result[..., 2 * i + 1] = hashes[..., rank], parts[..., rank]
    return result


def metadata(view_layer: str, kind: str, names: Sequence[str]) -> list[tuple[str, str]]:
    """(name, value) of what Blender's Cryptomatte node, and others, find the passes and their names by."""
    typename = f"{view_layer}.Crypto{kind.capitalize()}"
    prefix = f"cryptomatte/{murmur3(typename.encode()):08x}"[: len("cryptomatte/") + 7]
    manifest = {name: f"{murmur3(name.encode()):08x}" for name in names}
    return [
        (f"{prefix}/name", typename),
        (f"{prefix}/hash", "MurmurHash3_32"),
        (f"{prefix}/conversion", "uint32_to_float32"),
        (f"{prefix}/manifest", json.dumps(manifest, separators=(",", ":"), ensure_ascii=False)),
    ]
