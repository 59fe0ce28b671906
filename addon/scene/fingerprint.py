# SPDX-License-Identifier: GPL-3.0-or-later
"""Digests of descriptions: equal for equal pictures."""

from __future__ import annotations

import hashlib
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from .description import (
    AreaLight,
    Mesh,
    NamedMaterial,
    Object,
    PointLight,
    SceneDescription,
    Spheres,
    SpotLight,
    SunLight,
)
from .program import Program, Texture

NAMED = (Object, Spheres, NamedMaterial, PointLight, SpotLight, SunLight, AreaLight)  # by names that nothing shows
LARGE = 1 << 14  # bytes of an array from which on its digest is kept


class Fingerprints:
    """Of descriptions that come one after another and share arrays, which are not written to."""

    def __init__(self) -> None:
        self._known: dict[int, tuple[Any, bytes]] = {}  # of the last description, by the arrays' ids
        self._used: dict[int, tuple[Any, bytes]] = {}

    def of(self, scene: SceneDescription) -> bytes:
        """16 bytes. Names count for nothing, nor does what objects have at random where no material asks for it."""
        without = {"name"} if _asks_for_random(scene) else {"name", "random"}
        state = hashlib.blake2b(digest_size=16)
        self._used = {}
        self._feed(state, scene, without)
        self._known = self._used
        return state.digest()

    def _feed(self, state: hashlib.blake2b, value: Any, without: set[str]) -> None:
        if isinstance(value, (Mesh, Texture)):
            state.update(value.digest)  # kept with it
        elif is_dataclass(value):
            left_out = without if isinstance(value, NAMED) else ()
            state.update(f"{type(value).__name__}(".encode())
            for item in fields(value):
                if item.name not in left_out:
                    self._feed(state, getattr(value, item.name), without)
            state.update(b")")
        elif isinstance(value, np.ndarray):
            state.update(f"{value.dtype}{value.shape}".encode())
            state.update(self._digest(value) if value.nbytes >= LARGE else _bytes(value))
        elif isinstance(value, tuple):
            state.update(b"[")
            for part in value:
                self._feed(state, part, without)
            state.update(b"]")
        else:
            state.update(f"{value!r},".encode())

    def _digest(self, array: np.ndarray[Any, Any]) -> bytes:
        known = self._known.get(id(array))
        if known is None:
            known = array, hashlib.blake2b(_bytes(array), digest_size=16).digest()
        self._used[id(array)] = known
        return known[1]


def _bytes(array: np.ndarray[Any, Any]) -> Any:
    return np.ascontiguousarray(array).reshape(-1).view(np.uint8).data


def _asks_for_random(scene: SceneDescription) -> bool:
    def programs(item: NamedMaterial) -> list[Program | None]:
        return [item.program, None if item.volume is None else item.volume.program]

    return any(
        "object_random" in instruction.modes
        for item in scene.materials
        for program in programs(item)
        if program is not None
        for instruction in program.instructions
    )
