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

    def all_matrices(self) -> Floats:
        """(n, 4, 4)"""
        return np.concatenate([np.asarray(m, np.float64).reshape(-1, 4, 4) for m in self.matrices])


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
            yield Placed(item, [np.array(item.matrix_world, np.float64)])
    yield from bulk.values()
    if by_loop:
        yield from _by_loop(depsgraph, by_loop)


def _may_have_instances(item: bpy.types.Object) -> bool:
    """`is_instancer` knows of particles, vertices and collections, not of Geometry Nodes."""
    return item.is_instancer or any(modifier.type == "NODES" for modifier in item.modifiers)


def _by_loop(depsgraph: bpy.types.Depsgraph, instancers: set[int]) -> Iterator[Placed]:
    """The slow way. One mesh may be shown by a temporary object per instance, so they are grouped by their data."""
    matrices: dict[tuple[int, int], list[Floats]] = {}

    def key(item: Any) -> tuple[int, int]:
        data = item.data
        return item.original.as_pointer(), 0 if data is None else data.as_pointer()

    for instance in depsgraph.object_instances:
        if instance.is_instance and instance.parent.original.as_pointer() in instancers:
            matrices.setdefault(key(instance.object), []).append(np.array(instance.matrix_world, np.float64))
    # The objects of the first loop are gone, so those of a second are handed out, each once.
    for instance in depsgraph.object_instances:
        if instance.is_instance and instance.parent.original.as_pointer() in instancers:
            found = matrices.pop(key(instance.object), None)
            if found is not None:
                yield Placed(instance.object, found)
                if not matrices:
                    return
