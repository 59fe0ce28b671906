# SPDX-License-Identifier: GPL-3.0-or-later
"""The plates of a field in bulk: the loop over a depsgraph's instances takes 20 to 100 times as long."""

import dataclasses
import itertools
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..export.attributes import colors
from ..export.kept import Kept
from . import node_group
from .field import prototypes
from .layout import euler_to_matrix

_CHUNK = 1 << 14  # plates at once, whose numbers stay in a core's cache


class Plates(NamedTuple):
    """The n instances of one prototype."""

    prototype: Any  # the evaluated object
    matrices: NDArray[np.float64]  # (n, 4, 4), in the world
    # Of each instance, the attribute of a name as a colour, (n, 4); None where there is none of the name.
    attribute: Callable[[str], NDArray[np.float32] | None]


def export_instances(evaluated_object: Any, depsgraph: Any, kept: Kept | None = None) -> list[Plates] | None:
    """The plates of every prototype in use, as depsgraph.object_instances has them. None where the object is no plain
    field (another modifier may have changed the points or the instances): then use the loop. Only valid for the object
    itself; where a collection that holds it is instanced, those matrices come on top.
    """
    original = evaluated_object.original
    if not original.glimmer_field.enabled or original.type != "MESH" or original.data.shape_keys is not None:
        return None
    modifier = node_group.find_modifier(original)
    if modifier is None or len(original.modifiers) != 1:
        return None
    if not (modifier.show_render if depsgraph.mode == "RENDER" else modifier.show_viewport):
        return None
    collection = node_group.plates(modifier)
    sources = [] if collection is None else prototypes(collection)
    if not sources:
        return None
    share = node_group.viewport_share(modifier) if depsgraph.mode == "VIEWPORT" else 1.0
    world = np.array(evaluated_object.matrix_world, dtype=np.float64)
    key = len(sources), share, world.tobytes()
    parts = (kept or Kept()).get(
        "places", (original.data.as_pointer(),), key, lambda: _split(original.data, len(sources), share, world)
    )
    if parts is None:
        return None
    return [
        Plates(source.evaluated_get(depsgraph), matrices, _attribute_of_some(original.data, order))
        for source, (order, matrices) in zip(sources, parts, strict=True)
        if len(order)
    ]


def _split(
    mesh: Any, count: int, share: float, world: NDArray[np.float64]
) -> list[tuple[NDArray[Any], NDArray[np.float64]]] | None:
    """Of each of so many prototypes the numbers of its plates, and where they stand. share: of all, that are shown."""
    points = read_points(mesh)
    if points is None:
        return None
    index = points.prototypes % count  # as the node Instance on Points takes it
    order = np.argsort(index, kind="stable")
    if share < 1.0:
        own = read_attribute(mesh, node_group.RANDOM)
        if own is None:
            return None
        order = order[own[order, 0] < np.float32(share)]
    matrices = points.matrices(order, world)
    bounds = np.searchsorted(index[order], np.arange(count + 1))
    return [(order[begin:end], matrices[begin:end]) for begin, end in itertools.pairwise(bounds)]


def _attribute_of_some(mesh: Any, part: NDArray[Any]) -> Callable[[str], NDArray[np.float32] | None]:
    def attribute(name: str) -> NDArray[np.float32] | None:
        values = read_attribute(mesh, name)
        return None if values is None else values[part]

    return attribute


def read_attribute(mesh: Any, name: str) -> NDArray[np.float32] | None:
    """(n, 4): an attribute of the points, as a colour; instances take it over."""
    attribute = mesh.attributes.get(name)
    return None if attribute is None or attribute.domain != "POINT" else colors(attribute)


@dataclasses.dataclass(frozen=True)
class Points:
    """The plates in the field's own space, as its mesh holds them: float32, n of each."""

    positions: NDArray[np.float32]  # (n, 3)
    rotations: NDArray[np.float32]  # (n, 3)
    scales: NDArray[np.float32]  # (n, 3)
    prototypes: NDArray[np.int32]

    def matrices(self, order: NDArray[Any], world: NDArray[np.float64]) -> NDArray[np.float64]:
        """(k, 4, 4): where those plates stand in the world, in that order."""
        result = np.empty((len(order), 4, 4))
        result[:, 3] = (0.0, 0.0, 0.0, 1.0)
        is_moved = not np.array_equal(world, np.eye(4))
        for begin in range(0, len(order), _CHUNK):
            part = order[begin : begin + _CHUNK]
            linear = euler_to_matrix(self.rotations[part].astype(np.float64))
            linear *= self.scales[part].astype(np.float64)[:, np.newaxis, :]
            positions = self.positions[part].astype(np.float64)
            if is_moved:
                linear = world[:3, :3] @ linear
                positions = positions @ world[:3, :3].T + world[:3, 3]
            result[begin : begin + len(part), :3, :3] = linear
            result[begin : begin + len(part), :3, 3] = positions
        return result


def read_points(mesh: Any) -> Points | None:
    """None if the mesh has lost its attributes."""
    n = len(mesh.vertices)
    attributes = [mesh.attributes.get(name) for name in (node_group.ROTATION, node_group.SCALE, node_group.PROTOTYPE)]
    if any(attribute is None or len(attribute.data) != n for attribute in attributes):
        return None
    rotation, scale, prototype = attributes
    positions, rotations, scales = (np.empty(3 * n, np.float32) for _ in range(3))
    index = np.empty(n, np.int32)
    mesh.vertices.foreach_get("co", positions)
    rotation.data.foreach_get("vector", rotations)
    scale.data.foreach_get("vector", scales)
    prototype.data.foreach_get("value", index)
    return Points(positions.reshape(n, 3), rotations.reshape(n, 3), scales.reshape(n, 3), index)
