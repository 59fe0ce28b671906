# SPDX-License-Identifier: GPL-3.0-or-later
"""What stands where: the depsgraph's objects and their instances, grouped by what they show, read in bulk.

A loop over `object_instances` takes 3 to 9 us an instance, a bulk read a hundredth of that; so the loop is kept for
instancers that no bulk read understands.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ..scene.description import Floats

if TYPE_CHECKING:
    import bpy

# (The evaluated instancer, the depsgraph) -> [(prototype object, (n, 4, 4) world matrices), ...], or None if it is none
# of its own.
BulkReader = Callable[["bpy.types.Object", "bpy.types.Depsgraph"], "Sequence[tuple[bpy.types.Object, Any]] | None"]


@dataclass(eq=False)
class Placed:
    """An evaluated object and where it stands, once or many times."""

    item: bpy.types.Object
    matrices: list[Floats] = field(default_factory=list)  # each (4, 4) or (n, 4, 4)
    random_ids: list[int] | None = None  # Blender's, one a matrix; None: not asked for

    def all_matrices(self) -> Floats:
        """(n, 4, 4)"""
        return np.concatenate([np.asarray(m, np.float64).reshape(-1, 4, 4) for m in self.matrices])

    def randoms(self) -> Floats:
        """(n,) of 0 to 1: what an Object Info node knows as Random. Those of a bulk read are of our own making."""
        own = name_hash(self.item.name)
        ids = self.random_ids
        if ids is None:
            count = len(self.all_matrices())
            ids = [hash_pair(own, i) for i in range(count)]
        return np.array(ids, np.float64) / 0xFFFFFFFF


def name_hash(name: str) -> int:
    """Blender's of an object's name, from which the Random of an Object Info node comes."""
    result = 0
    for byte in name.encode():
        result = (result * 37 + byte) & 0xFFFFFFFF
    return result


def hash_pair(x: int, y: int) -> int:
    """Bob Jenkins' lookup3 of two 32-bit words."""

    def rot(v: int, bits: int) -> int:
        return (v << bits | v >> (32 - bits)) & 0xFFFFFFFF

    c = 0xDEADBEEF + (2 << 2) + 13
    a, b = (c + x) & 0xFFFFFFFF, (c + y) & 0xFFFFFFFF
    for bits in (14, 11, 25, 16, 4, 14, 24):
        # The three words take turns: c by b, a by c, b by a.
        c = ((c ^ b) - rot(b, bits)) & 0xFFFFFFFF
        a, b, c = b, c, a
    # After seven turns the last word that was changed stands in b.
    return b


def placed_objects(
    depsgraph: bpy.types.Depsgraph,
    readers: tuple[BulkReader, ...],
    is_shown: Callable[[bpy.types.Object], bool] | None = None,
) -> Iterator[Placed]:
    """Everything visible. An object is valid only until the next is asked for: an instance's may be a temporary one."""
    by_loop: set[int] = set()
    bulk: dict[int, Placed] = {}
    show_instancer = "show_instancer_for_render" if depsgraph.mode == "RENDER" else "show_instancer_for_viewport"
    for item in depsgraph.objects:
        if is_shown is not None and not is_shown(item):
            continue
        if _may_have_instances(item):
            found = next((result for reader in readers if (result := reader(item, depsgraph)) is not None), None)
            if found is None:
                by_loop.add(item.original.as_pointer())
            else:
                for prototype, matrices in found:
                    bulk.setdefault(prototype.as_pointer(), Placed(prototype)).matrices.append(matrices)
        if not item.is_instancer or getattr(item, show_instancer):
            yield Placed(item, [np.array(item.matrix_world, np.float64)], [hash_pair(name_hash(item.name), 0)])
    yield from bulk.values()
    if by_loop:
        yield from _by_loop(depsgraph, by_loop)


def _may_have_instances(item: bpy.types.Object) -> bool:
    """`is_instancer` knows of particles, vertices and collections, not of Geometry Nodes."""
    return item.is_instancer or any(modifier.type == "NODES" for modifier in item.modifiers)


def _by_loop(depsgraph: bpy.types.Depsgraph, instancers: set[int]) -> Iterator[Placed]:
    """The slow way. One mesh may be shown by a temporary object per instance, so they are grouped by their data."""
    matrices: dict[tuple[int, int], list[Floats]] = {}
    random_ids: dict[tuple[int, int], list[int]] = {}

    def key(item: Any) -> tuple[int, int]:
        data = item.data
        return item.original.as_pointer(), 0 if data is None else data.as_pointer()

    for instance in depsgraph.object_instances:
        if instance.is_instance and instance.parent.original.as_pointer() in instancers:
            matrices.setdefault(key(instance.object), []).append(np.array(instance.matrix_world, np.float64))
            random_ids.setdefault(key(instance.object), []).append(instance.random_id & 0xFFFFFFFF)
    # The objects of the first loop are gone, so those of a second are handed out, each once.
    for instance in depsgraph.object_instances:
        if instance.is_instance and instance.parent.original.as_pointer() in instancers:
            found = matrices.pop(key(instance.object), None)
            if found is not None:
                yield Placed(instance.object, found, random_ids[key(instance.object)])
                if not matrices:
                    return
