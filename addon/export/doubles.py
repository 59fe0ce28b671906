# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that lie on others, as copies do that were never moved: in Cycles they shade each other, from 3.4 to 5.3, as
their rays start on one and at once meet the other."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable

import numpy as np

from ..scene.description import Object, Rays
from ..scene.problems import Notices, place

DECIMALS = 6  # to which matrices are held against each other
MOST_PLACES = 100_000  # that are


def warn_of_doubled_objects(objects: Iterable[Object], notices: Notices) -> None:
    """The instances of one Object are not held against each other, nor those of more than one beyond MOST_PLACES:
    there may be very many."""
    of_size: dict[tuple[int, int], list[Object]] = defaultdict(list)
    for item in objects:
        if item.rays & Rays.CAMERA and item.interior is None:
            of_size[len(item.mesh.vertices), len(item.mesh.triangles)].append(item)
    for alike in of_size.values():
        of_shape: dict[bytes, list[Object]] = defaultdict(list)
        if len(alike) > 1:
            for item in alike:
                of_shape[item.mesh.shape_digest].append(item)
        for same in of_shape.values():
            count = sum(1 if item.instances is None else len(item.instances) for item in same)
            if len(same) > 1 and count <= MOST_PLACES:
                _warn_of(same, notices)


def _warn_of(same: list[Object], notices: Notices) -> None:
    """Of objects of one shape."""
    names: dict[bytes, str] = {}  # by place, of the object that was there first
    for item in same:
        places = _places(item)
        first = next((names[at] for at in places if at in names), None)
        if first is not None:
            other = "another of its instances" if first == item.name else f"object '{first}'"
            notices.add(place(item.name), f"lies on {other}, which Cycles shows with dark spots")
        names.update(dict.fromkeys(places, item.name))


def _places(item: Object) -> list[bytes]:
    """The matrices of its instances."""
    to_world = np.asarray(item.to_world, np.float64)
    matrices = to_world[None] if item.instances is None else to_world @ item.instances
    return [matrix.tobytes() for matrix in np.round(matrices, DECIMALS) + 0.0]  # -0 is 0
