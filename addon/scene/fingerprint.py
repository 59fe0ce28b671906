# SPDX-License-Identifier: GPL-3.0-or-later
"""A digest of a description: equal for equal contents."""

from __future__ import annotations

import hashlib
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from .description import Mesh


def fingerprint(value: Any) -> bytes:
    """16 bytes. value: dataclasses, tuples, arrays and what `repr` tells apart."""
    state = hashlib.blake2b(digest_size=16)
    _feed(state, value)
    return state.digest()


def _feed(state: hashlib.blake2b, value: Any) -> None:
    if isinstance(value, Mesh):
        state.update(value.digest)  # kept with the mesh
    elif is_dataclass(value):
        state.update(f"{type(value).__name__}(".encode())
        for item in fields(value):
            _feed(state, getattr(value, item.name))
        state.update(b")")
    elif isinstance(value, np.ndarray):
        state.update(f"{value.dtype}{value.shape}".encode())
        state.update(np.ascontiguousarray(value).reshape(-1).view(np.uint8).data)
    elif isinstance(value, tuple):
        state.update(b"[")
        for part in value:
            _feed(state, part)
        state.update(b"]")
    else:
        state.update(f"{value!r},".encode())
