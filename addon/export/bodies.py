# SPDX-License-Identifier: GPL-3.0-or-later
"""Where bodies of glass are not what they are in Cycles: there each face has air before it, whatever is around, and
what fills the world fills them, too. Glass that encloses no body is as in Cycles."""

from __future__ import annotations

import numpy as np

from ..scene.description import Floats, Object, SceneDescription
from ..scene.problems import Notices, place
from .material import has_glass

MOST_BODIES = 2000  # that are held against each other


def warn_of_bodies_of_glass(scene: SceneDescription, world: str, notices: Notices) -> None:
    glass = {number for number, item in enumerate(scene.materials) if has_glass(item.material)}
    objects = (item for item in scene.objects if glass & set(item.materials) and item.mesh.is_closed)
    bodies = [(item.name, _bounds(item)) for item in objects]
    for spheres in scene.spheres:
        if spheres.material in glass:
            radii = np.broadcast_to(spheres.radii, len(spheres.centers))[:, None]
            bodies.append((spheres.name, np.stack([spheres.centers - radii, spheres.centers + radii], axis=1)))
    if not bodies:
        return
    if scene.medium is not None:
        notices.add(f"world '{world}'", "its volume is not in bodies of glass; in Cycles it is")
    names = [name for name, bounds in bodies for _ in bounds][:MOST_BODIES]
    bounds = np.concatenate([bounds for _, bounds in bodies])[:MOST_BODIES]
    low, high = bounds[:, 0], bounds[:, 1]
    for number, name in enumerate(names):
        meets = ((low[:number] < high[number]) & (high[:number] > low[number])).all(axis=1)
        if meets.any():
            other = names[int(meets.argmax())]
            notices.add(
                place(name),
                f"where its glass reaches into that of '{other}', light passes from one to the other; in Cycles there"
                " is air before every face",
            )


def _bounds(item: Object) -> Floats:
    """(n, 2, 3): of its instances, the lowest and the highest coordinates."""
    low, high = item.mesh.vertices.min(axis=0), item.mesh.vertices.max(axis=0)
    corners = np.array([[(low, high)[i >> k & 1][k] for k in range(3)] for i in range(8)], np.float64)
    places = np.asarray(item.to_world, np.float64)[None] if item.instances is None else item.to_world @ item.instances
    placed = np.einsum("nij,kj->nki", places[:, :3, :3], corners) + places[:, None, :3, 3]
    return np.stack([placed.min(axis=1), placed.max(axis=1)], axis=1)
