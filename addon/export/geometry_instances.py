# SPDX-License-Identifier: GPL-3.0-or-later
"""The attributes that geometry nodes give instances.

Blender lists instances without them; but it numbers the way to each instance, level by level, and from 5.0 on hands
over the evaluated geometry of objects, through which that way leads.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .attributes import colors

if TYPE_CHECKING:
    import bpy

NO_LEVEL = 2**31 - 1  # fills up the numbers of the way to an instance


class LostError(Exception):
    """Why nobody knows what geometry nodes gave an instance."""


class _StrangerError(Exception):
    """A number that an instance was given since it shares its id with another."""

    def __init__(self, level: _Level, number: int) -> None:
        self.level, self.number = level, number


class _Level:
    """What geometry nodes made, among it instances."""

    def __init__(self, geometry: bpy.types.GeometrySet, own_type: str | None) -> None:
        """own_type: of the object that is this geometry and shows that part of it itself; None for an instance."""
        self._geometry = geometry  # of which the rest is a part
        self._references = geometry.instance_references()
        self._points = geometry.instances_pointcloud()
        parts = {
            "MESH": geometry.mesh,
            "VOLUME": geometry.volume,
            "CURVES": geometry.curves,
            "POINTCLOUD": geometry.pointcloud,
            "GREASEPENCIL": geometry.grease_pencil,
        }
        own_type = "CURVES" if own_type in ("CURVE", "FONT") else own_type
        self.parts = sum(part is not None for kind, part in parts.items() if kind != own_type)
        self._children: dict[int, _Level] = {}
        self._colors: dict[str, NDArray[np.float32] | None] = {}
        count = 0 if self._points is None else len(self._points.points)
        self._reference_of = self._integers(".reference_index", np.zeros(count, np.int32))
        ids = self._integers("id", np.arange(count, dtype=np.int32))
        # Of instances that share an id Blender numbers the first by it, and the others at random.
        self.index_of: dict[int, int] = {}
        self._others = [
            index for index, number in enumerate(ids.tolist()) if self.index_of.setdefault(number, index) != index
        ]
        self.strangers: dict[int, None] = {}  # numbers of those, in their order

    def knows_strangers(self) -> bool:
        """Whether their numbers stand for all that share an id; then they are found by those from now on."""
        if len(self.strangers) != len(self._others):
            return False
        self.index_of |= zip(self.strangers, self._others, strict=True)
        self.strangers, self._others = {}, []
        return True

    def _integers(self, name: str, otherwise: NDArray[np.int32]) -> NDArray[np.int32]:
        attribute = None if self._points is None else self._points.attributes.get(name)
        if attribute is None or attribute.data_type != "INT":
            return otherwise
        values = np.empty(len(attribute.data), np.int32)
        attribute.data.foreach_get("value", values)
        return values

    def child(self, index: int) -> Any:
        """What an instance shows: a level, an object or a collection."""
        number = int(self._reference_of[index])
        reference = self._references[number]
        if type(reference).__name__ != "GeometrySet":
            return reference
        if number not in self._children:
            self._children[number] = _Level(reference, None)
        return self._children[number]

    def color(self, name: str, index: int) -> tuple[float, float, float, float] | None:
        if name not in self._colors:
            self._colors[name] = self._read_colors(name)
        values = self._colors[name]
        if values is None:
            return None
        red, green, blue, alpha = values[index].tolist()
        return red, green, blue, alpha

    def _read_colors(self, name: str) -> NDArray[np.float32] | None:
        """None of a position, which only the points have that stand for instances here."""
        return None if self._points is None or name == "position" else colors(self._points.attributes.get(name))


class GeometryInstances:
    """Of the objects of one depsgraph, at one moment."""

    def __init__(self, depsgraph: bpy.types.Depsgraph) -> None:
        import bpy

        self._depsgraph = depsgraph
        self._hidden = "hide_render" if depsgraph.mode == "RENDER" else "hide_viewport"
        self._levels: dict[int, _Level | None] = {}  # by the object's pointer
        self._met: set[bpy.types.Object] = set()  # of whose instances the numbers were looked through
        modifiers = (modifier for item in bpy.data.objects for modifier in item.modifiers)
        self._has_nodes = any(modifier.type == "NODES" for modifier in modifiers)

    def color(
        self, instancer: bpy.types.Object, numbers: tuple[int, ...], name: str
    ) -> tuple[float, float, float, float] | None:
        """What geometry nodes gave an instance under a name, as a colour, or None: that of the innermost level which
        has the name, as in Cycles.

        instancer: an original object. numbers: Blender's persistent_id. Raises LostError."""
        if not self._has_nodes:
            return None
        if not hasattr(instancer, "evaluated_geometry"):
            if instancer.instance_type != "COLLECTION" and all(m.type != "NODES" for m in instancer.modifiers):
                return None
            raise LostError("Blender hands them over from 5.0 on")
        try:
            way = self._way(instancer, numbers)
        except _StrangerError:
            self._meet_strangers(instancer)
            try:
                way = self._way(instancer, numbers)
            except _StrangerError as error:
                raise LostError("several instances share an id") from error
        found = (level.color(name, index) for level, index in reversed(way))
        return next((color for color in found if color is not None), None)

    def _meet_strangers(self, instancer: bpy.types.Object) -> None:
        """Blender lists the instances of a level in their order, and so the numbers that it gave at random."""
        if instancer in self._met:
            return
        self._met.add(instancer)
        shown = (item for item in self._depsgraph.object_instances if item.is_instance)
        ways = [tuple(item.persistent_id) for item in shown if item.parent.original == instancer]
        levels: set[_Level] = set()
        for numbers in ways:
            try:
                self._way(instancer, numbers)
            except _StrangerError as stranger:
                stranger.level.strangers[stranger.number] = None
                levels.add(stranger.level)
        if any(level.knows_strangers() for level in levels):
            self._met.discard(instancer)  # there may be more within those
            self._meet_strangers(instancer)

    def _way(self, instancer: bpy.types.Object, numbers: tuple[int, ...]) -> list[tuple[_Level, int]]:
        evaluated = instancer.evaluated_get(self._depsgraph)
        return [*self._steps(evaluated, [number for number in numbers if number != NO_LEVEL])]

    def _steps(self, item: bpy.types.Object, numbers: list[int]) -> Iterator[tuple[_Level, int]]:
        """The levels through which an instance by an evaluated object is reached, outermost first, and what stands for
        it on each. Takes its numbers from the end, which is the outermost."""
        place: Any = item
        while numbers:
            if hasattr(place, "evaluated_geometry"):
                place = self._level(place) or place
            number = numbers.pop()
            if isinstance(place, _Level):
                if place.parts:
                    if not numbers:
                        return  # what stands beside the instances
                    number = numbers.pop()  # the one before only says that it is none of that
                index = place.index_of.get(number)
                if index is None:
                    raise _StrangerError(place, number)
                yield place, index
                place = place.child(index)
            elif not numbers:
                return  # no geometry nodes are within
            elif hasattr(place, "all_objects"):
                place = self._visible(place, number // 2)  # each counts twice: what it is, and what it shows in turn
            elif place.instance_type == "COLLECTION":
                place = self._visible(place.instance_collection, number)
            else:
                raise LostError("faces, vertices or particles show the instances in turn")

    def _visible(self, collection: bpy.types.Collection, number: int) -> bpy.types.Object:
        """One of a collection's objects that are shown, as Blender counts them."""
        shown: dict[bpy.types.Object, bool] = {}

        def add(part: bpy.types.Collection, is_hidden: bool) -> None:
            is_hidden = is_hidden or getattr(part, self._hidden)
            for item in part.objects:
                shown[item] = shown.get(item, False) or not (is_hidden or getattr(item, self._hidden))
            for child in part.children:
                add(child, is_hidden)

        add(collection, False)
        items = [item for item, is_shown in shown.items() if is_shown]
        if not 0 <= number < len(items):
            raise LostError("it cannot be told which object of a collection shows the instances")
        return items[number].evaluated_get(self._depsgraph)

    def _level(self, item: bpy.types.Object) -> _Level | None:
        """Of an evaluated object's geometry, if it holds instances."""
        key = item.as_pointer()
        if key not in self._levels:
            # An empty would be told to hold its collection, but is numbered without that level.
            geometry = None if item.type == "EMPTY" else item.evaluated_geometry()
            has_instances = geometry is not None and geometry.instances_pointcloud() is not None
            self._levels[key] = _Level(geometry, item.type) if has_instances else None
        return self._levels[key]
