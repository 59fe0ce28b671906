# SPDX-License-Identifier: GPL-3.0-or-later
"""What an earlier export of the same depsgraph read, and no edit has touched since.

Blender tells of every edit whose data it evaluated anew, and whether a shape or only a place is another now. Lamps, the
world, the camera and the places of single objects are read each time: that costs less than to know whether it must be.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Hashable, Iterable
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    import bpy

Value = TypeVar("Value")

# Kinds of data of which nothing is kept, and of which objects that depend on them are told of too.
READ_EACH_TIME = {"Scene", "Collection", "World", "Camera", "LightProbe", "Armature", "Action", "Key"}
SHAPES = {"Mesh", "Curve", "TextCurve", "SurfaceCurve", "Curves", "PointCloud", "Volume", "MetaBall", "Lattice"}


class Kept:
    """Of one depsgraph; cleared by whoever shows another."""

    def __init__(self) -> None:
        # By kind and key: whose it is, as pointers of original data, and what it is.
        self._items: dict[tuple[str, Hashable], tuple[tuple[int, ...], Any]] = {}
        self._used: set[tuple[str, Hashable]] = set()
        self.reads: Counter[str] = Counter()  # how often each kind was read from Blender, for tests and the curious

    def get(
        self,
        kind: str,
        owners: tuple[int, ...],
        key: Hashable,
        read: Callable[[], Value],
        may_keep: Callable[[], bool] = lambda: True,
    ) -> Value:
        """What was read before under this key, or is read now. may_keep: asked after that."""
        place = kind, (owners, key)
        self._used.add(place)
        if place in self._items:
            found: Value = self._items[place][1]
            return found
        self.reads[kind] += 1
        value = read()
        if may_keep():
            self._items[place] = owners, value
        return value

    def drop_unused(self) -> None:
        """What nobody asked for since the last call; a pointer may stand for something else by then."""
        self._items = {place: item for place, item in self._items.items() if place in self._used}
        self._used = set()

    def clear(self) -> None:
        self._items.clear()

    def follow(self, updates: Iterable[bpy.types.DepsgraphUpdate]) -> None:
        """Forgets what these may have changed."""
        listed = [(update.id.bl_rna.identifier, update.id.original, update) for update in updates]
        reshaped = {item.as_pointer() for kind, item, update in listed if kind in SHAPES and update.is_updated_geometry}
        reshaded = {item.as_pointer() for kind, item, _ in listed if kind in SHAPES} - reshaped
        is_material = any(kind == "Material" for kind, _, _ in listed)
        changed = set(reshaped)
        for kind, item, update in listed:
            if kind == "Object":
                data = 0 if item.data is None else item.data.as_pointer()
                # Since 5.x Blender says that the shape is another where only a material is.
                only_shaded = is_material and data in reshaded and _has_its_own_shape(item)
                if update.is_updated_geometry and not only_shaded:
                    changed.add(item.as_pointer())
            elif kind == "Material":
                changed.add(item.as_pointer())
            elif kind not in SHAPES | READ_EACH_TIME and not kind.endswith("Light") and not item.is_embedded_data:
                self.clear()  # a group of nodes, an image, a texture: whatever uses it
        if changed:
            self._items = {place: item for place, item in self._items.items() if changed.isdisjoint(item[0])}


def _has_its_own_shape(item: bpy.types.Object) -> bool:
    """Which is that of its data, whatever else there is."""
    return item.type == "MESH" and not item.modifiers and not item.particle_systems and item.data.shape_keys is None


def owners_of(item: bpy.types.Object) -> tuple[int, ...]:
    """Whose changes change the shape of an evaluated object."""
    data = item.original.data
    return item.original.as_pointer(), 0 if data is None else data.as_pointer()
