# SPDX-License-Identifier: GPL-3.0-or-later
"""What stands where: the depsgraph's objects and their instances, grouped by what they show, read in bulk.

`object_instances` is what Cycles reads: it alone knows which instancers are hidden, and that a curve is shown by its
mesh. A loop over it takes 3 to 9 us an instance, a bulk read a hundredth of that; so scenes of plain meshes, lights and
instancers that are read in bulk go without it.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..scene.description import Floats
from .kept import Kept
from .visibility import SEEN, Visibility, visibility

if TYPE_CHECKING:
    import bpy

# Of the instances by one object: the attribute of a name as a colour, (n, 4), or None where there is none of the name.
AttributeReader = Callable[[str], "NDArray[np.float32] | None"]
# (The evaluated instancer, the depsgraph, what earlier reads left) -> [(prototype object, (n, 4, 4) world matrices,
# their attributes), ...], or None if it is none of its own. Places that did not change are the very same arrays.
BulkReader = Callable[
    ["bpy.types.Object", "bpy.types.Depsgraph", Kept], "Sequence[tuple[bpy.types.Object, Any, AttributeReader]] | None"
]


@dataclass(frozen=True, eq=False)
class Record:
    """What Blender says of one instance."""

    particles: Any  # the settings of the particle system that it is of, or None
    instancer: Any  # the original object, or None
    numbers: tuple[int, ...]  # Blender's persistent_id
    generated: tuple[float, float, float]  # where it stands in its instancer's own coordinates
    uv: tuple[float, float]
    particle_index: int
    particle: dict[str, tuple[float, ...]]  # by the names of a Particle Info node's outputs; empty for none


def _record(instance: Any, frame: float) -> Record:
    parent, system = instance.parent, instance.particle_system
    owner = None if parent is None else parent.original
    orco, uv, numbers = tuple(instance.orco), tuple(instance.uv), tuple(instance.persistent_id)
    if system is None:
        return Record(None, owner, numbers, orco, uv, 0, {})
    index = numbers[0]
    values: dict[str, tuple[float, ...]] = {}
    if 0 <= index < len(system.particles):
        particle = system.particles[index]
        values = {
            "Age": (frame - particle.birth_time,),
            "Lifetime": (particle.lifetime,),
            "Size": (particle.size,),
            "Location": tuple(particle.location),
            "Velocity": tuple(particle.velocity),
            "Angular Velocity": tuple(particle.angular_velocity),
        }
    return Record(system.settings.original, owner, numbers, orco, uv, index, values)


@dataclass(eq=False)
class Placed:
    """An evaluated object and where it stands, once or many times."""

    item: bpy.types.Object
    strands: bool = False  # what is shown is the hair of its particle systems, not its surface
    matrices: list[Floats] = field(default_factory=list)  # each (4, 4) or (n, 4, 4)
    random_ids: list[int] | None = None  # Blender's, one a matrix; None: not asked for
    # One a member of `matrices`: the same object, or instances by the same object, at all moments.
    ids: list[Hashable] = field(default_factory=list)
    records: list[Record] = field(default_factory=list)  # of instances that Blender listed, one a matrix
    # Of instances that were read in bulk: one a member of `matrices`, each with its instancer.
    bulk: list[tuple[bpy.types.Object, AttributeReader]] = field(default_factory=list)
    instancer: bpy.types.Object | None = None  # the last of those that it is an instance by
    visibility: Visibility = SEEN
    label: str = ""  # what an artist knows it by, where the object itself is hidden from sight

    @property
    def name(self) -> str:
        """For notices."""
        return self.label or str(self.item.name)

    def all_matrices(self) -> Floats:
        """(n, 4, 4). The last row is that of a matrix of places, whatever rounding made of it."""
        parts = [np.asarray(m, np.float64).reshape(-1, 4, 4) for m in self.matrices]
        if len(parts) == 1 and self.bulk and (parts[0][:, 3] == (0.0, 0.0, 0.0, 1.0)).all():
            return parts[0]  # of millions, which nobody changes
        result = np.concatenate(parts)
        result[:, 3] = (0.0, 0.0, 0.0, 1.0)
        return result

    def by_id(self) -> Iterator[tuple[Hashable, Floats]]:
        """Each id and its (n, 4, 4)."""
        for ident, matrices in zip(self.ids, self.matrices, strict=True):
            result = np.array(matrices, np.float64).reshape(-1, 4, 4)
            result[:, 3] = (0.0, 0.0, 0.0, 1.0)
            yield ident, result

    def randoms(self) -> Floats:
        """(n,) of 0 to 1: what an Object Info node knows as Random. Those of a bulk read are of our own making."""
        own = name_hash(self.item.name)
        ids = self.random_ids
        if ids is None:
            count = sum(m.size // 16 for m in map(np.asarray, self.matrices))
            return hash_pairs(own, np.arange(count)) / 0xFFFFFFFF
        return np.array(ids, np.float64) / 0xFFFFFFFF


def dimensions_left(matrices: Floats) -> NDArray[np.intp]:
    """(n,): 3, or what a scale of 0 along some axes leaves of them."""
    result = np.full(len(matrices), 3)
    for begin in range(0, len(matrices), 1 << 14):  # so much stays in a core's cache
        linear = matrices[begin : begin + (1 << 14), :3, :3]
        x, y, z = np.moveaxis(linear, 2, 0)
        volume = np.abs((np.cross(x, y) * z).sum(axis=1))
        lengths = [np.sqrt((axis * axis).sum(axis=1)) for axis in (x, y, z)]
        flat = volume <= 1e-12 * lengths[0] * lengths[1] * lengths[2]
        if flat.any():
            result[begin + np.flatnonzero(flat)] = np.minimum(np.linalg.matrix_rank(linear[flat]), 2)
    return result


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


def hash_pairs(x: int, y: NDArray[np.int64]) -> NDArray[np.int64]:
    """hash_pair of x and each y."""
    word, result = np.uint32, np.empty(len(y), np.int64)
    for begin in range(0, len(y), 1 << 14):  # so much stays in a core's cache
        part = y[begin : begin + (1 << 14)].astype(word)
        start = (0xDEADBEEF + (2 << 2) + 13) & 0xFFFFFFFF
        a, b, c = np.full_like(part, (start + x) & 0xFFFFFFFF), part + word(start), np.full_like(part, start)
        for bits in (14, 11, 25, 16, 4, 14, 24):
            c = (c ^ b) - (b << word(bits) | b >> word(32 - bits))
            a, b, c = b, c, a
        result[begin : begin + len(part)] = b
    return result


def placed_objects(
    depsgraph: bpy.types.Depsgraph,
    readers: tuple[BulkReader, ...],
    kept: Kept,
    is_shown: Callable[[bpy.types.Object], bool] | None = None,
) -> Iterator[Placed]:
    """Everything visible. An object is valid only until the next is asked for: an instance's may be a temporary one."""
    plain = True
    bulk: dict[tuple[int, Visibility], Placed] = {}
    read_in_bulk: set[int] = set()
    present: set[int] = set()
    layer = depsgraph.view_layer
    for item in depsgraph.objects:
        present.add(item.original.as_pointer())
        if is_shown is not None and not is_shown(item):
            continue
        if _may_have_instances(item):
            found = next((result for reader in readers if (result := reader(item, depsgraph, kept)) is not None), None)
            if found is None:
                plain = False
                continue
            read_in_bulk.add(item.original.as_pointer())
            for prototype, matrices, attribute in found:
                seen = visibility(prototype, item, layer)
                placed = bulk.setdefault(
                    (prototype.as_pointer(), seen), Placed(prototype, visibility=seen, label=item.name)
                )
                placed.matrices.append(matrices)
                placed.ids.append(("bulk", item.original.as_pointer(), prototype.original.as_pointer()))
                placed.bulk.append((item.original, attribute))
                placed.instancer = item.original
        elif item.type in SHOWN_BY_OTHERS:
            plain = False
    if plain and not _has_hidden_instancers(depsgraph, present):
        for item in depsgraph.objects:
            if is_shown is None or is_shown(item):
                yield placed_once(item, layer)
    else:
        yield from _by_loop(depsgraph, read_in_bulk, is_shown)
    yield from bulk.values()


# Kinds that a temporary object with their mesh stands for, in object_instances alone.
SHOWN_BY_OTHERS = {"CURVE", "SURFACE", "FONT", "META"}


def placed_once(item: bpy.types.Object, layer: bpy.types.ViewLayer) -> Placed:
    """Where the object itself stands."""
    return Placed(
        item,
        False,
        [np.array(item.matrix_world, np.float64)],
        [hash_pair(name_hash(item.name), 0)],
        [("object", item.original.as_pointer())],
        visibility=visibility(item, None, layer),
    )


def _may_have_instances(item: bpy.types.Object) -> bool:
    """`is_instancer` knows of vertices, faces and collections, not of particles and Geometry Nodes."""
    return (
        item.is_instancer
        or len(item.particle_systems) > 0
        or any(modifier.type == "NODES" for modifier in item.modifiers)
    )


def _has_hidden_instancers(depsgraph: bpy.types.Depsgraph, present: set[int]) -> bool:
    """Whether there may be some: the depsgraph's objects are without them, its instances have what they show."""
    name = "show_instancer_for_render" if depsgraph.mode == "RENDER" else "show_instancer_for_viewport"
    return any(
        not getattr(item, name) and item.original.as_pointer() not in present and _may_have_instances(item)
        for item in depsgraph.view_layer_eval.objects
    )


# Of an instance: whose it is, its data, whether it is hair, and what sees it.
Key = tuple[int, int, bool, Visibility]


def _by_loop(
    depsgraph: bpy.types.Depsgraph,
    left_out: set[int],
    is_shown: Callable[[bpy.types.Object], bool] | None,
) -> Iterator[Placed]:
    """The slow way, but for the instances of some. One mesh may be shown by a temporary object per instance, so
    instances are grouped by their data."""
    groups: dict[Key, Placed] = {}
    layer = depsgraph.view_layer
    known: dict[tuple[int, int], Visibility] = {}

    def keys(instance: bpy.types.DepsgraphObjectInstance) -> list[Key]:
        """What an instance shows: its surface, its hair or both."""
        item, data = instance.object, instance.object.data
        pair = item.original.as_pointer(), instance.parent.original.as_pointer()
        if pair not in known:
            known[pair] = visibility(item, instance.parent, layer)
        whose = pair[0], 0 if data is None else data.as_pointer()
        shown = ((False, instance.show_self), (True, instance.show_particles))
        return [(*whose, strands, known[pair]) for strands, is_shown in shown if is_shown]

    frame = depsgraph.scene_eval.frame_current_final
    for instance in depsgraph.object_instances:
        if not instance.is_instance:
            item = instance.object
            if is_shown is None or is_shown(item):
                if instance.show_self:
                    yield placed_once(item, layer)
                if instance.show_particles:
                    placed = placed_once(item, layer)
                    placed.strands = True
                    yield placed
            continue
        parent = instance.parent
        if parent.original.as_pointer() in left_out or (is_shown is not None and not is_shown(parent)):
            continue
        matrix, random = np.array(instance.matrix_world, np.float64), instance.random_id & 0xFFFFFFFF
        ident = (parent.original.as_pointer(), instance.object.original.as_pointer(), tuple(instance.persistent_id))
        for key in keys(instance):
            group = groups.get(key)
            if group is None:
                group = groups[key] = Placed(instance.object, key[2], [], [], visibility=key[3])
            group.matrices.append(matrix)
            group.ids.append(ident)
            group.instancer = parent.original
            group.records.append(_record(instance, frame))
            group.random_ids.append(random)  # type: ignore[union-attr]
    if not groups:
        return
    # The objects of the first loop are gone, so those of a second are handed out, each once.
    for instance in depsgraph.object_instances:
        if instance.is_instance:
            for key in keys(instance):
                group = groups.pop(key, None)
                if group is not None:
                    group.item = instance.instance_object if group.strands else instance.object
                    yield group
            if not groups:
                return
