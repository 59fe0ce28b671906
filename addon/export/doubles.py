# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that lie on others, as copies do that were never moved: in Cycles they shade each other, from 3.4 to 5.3, as
their rays start on one and at once meet the other."""

from __future__ import annotations

import hashlib
from collections import defaultdict
from collections.abc import Iterable

import numpy as np

from ..scene.description import Mesh, Object, Rays
from ..scene.problems import Notices, place

DECIMALS = 6  # to which matrices are held against each other


def warn_of_doubled_objects(objects: Iterable[Object], notices: Notices) -> None:
    """The instances of one Object are not held against each other: there may be very many."""
    of_size: dict[tuple[int, int], list[Object]] = defaultdict(list)
    for item in objects:
        if item.rays & Rays.CAMERA and item.interior is None:
            of_size[len(item.mesh.vertices), len(item.mesh.triangles)].append(item)
    for alike in of_size.values():
        if len(alike) > 1:
            _warn_of(alike, notices)


def _warn_of(alike: list[Object], notices: Notices) -> None:
    digests = {id(item.mesh): _digest(item.mesh) for item in alike}
    names: dict[tuple[bytes, bytes], str] = {}  # by shape and place, of the object that was there first
    for item in alike:
        keys = [(digests[id(item.mesh)], matrix) for matrix in _places(item)]
        first = next((names[key] for key in keys if key in names), None)
        if first is not None:
            other = "another of its instances" if first == item.name else f"object '{first}'"
            notices.add(place(item.name), f"lies on {other}, which Cycles shows with dark spots")
        names.update(dict.fromkeys(keys, item.name))


def _digest(mesh: Mesh) -> bytes:
    """Equal for meshes of the same shape."""
    state = hashlib.blake2b(digest_size=16)
    for rows in (mesh.vertices, mesh.triangles):
        state.update(np.ascontiguousarray(rows).reshape(-1).view(np.uint8).data)
    return state.digest()


def _places(item: Object) -> list[bytes]:
    """The matrices of its instances."""
    to_world = np.asarray(item.to_world, np.float64)
    matrices = to_world[None] if item.instances is None else to_world @ item.instances
    return [matrix.tobytes() for matrix in np.round(matrices, DECIMALS) + 0.0]  # -0 is 0
