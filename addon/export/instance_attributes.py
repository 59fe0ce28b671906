# SPDX-License-Identifier: GPL-3.0-or-later
"""What shader programs ask of each instance by name: properties of its object or instancer, its particle, and where it
stands on its instancer."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..scene.description import Attribute
from ..scene.problems import Notices, place
from .attributes import texture_space
from .geometry_instances import GeometryInstances, LostError
from .instance import Placed, Record, hash_pair
from .translate.surface import (
    INSTANCER_GENERATED,
    INSTANCER_PREFIX,
    INSTANCER_UV,
    OBJECT_PREFIX,
    PARTICLE_PREFIX,
    VOLUME_OFFSET,
    VOLUME_SCALE,
)

if TYPE_CHECKING:
    import bpy

Rgba = tuple[float, float, float, float]
BLACK_AND_CLEAR = (0.0, 0.0, 0.0, 0.0)


def instance_attributes(
    placed: Placed, names: frozenset[str], made: GeometryInstances, notices: Notices
) -> tuple[Attribute, ...]:
    """Those of `names` that instances have, a row for each matrix. made: what geometry nodes gave them."""
    found = []
    for name in sorted(names):
        if placed.bulk:
            rows: Any = _bulk_rows(placed, name)
        elif name.startswith(INSTANCER_PREFIX) and placed.records:
            own = name[len(INSTANCER_PREFIX) :]
            rows = [_of_instance(placed, record, own, made, notices) for record in placed.records]
        else:
            rows = _rows(placed, name)
        if rows is not None:
            found.append(Attribute(name, "instance", np.nan_to_num(np.asarray(rows, np.float32), copy=False)))
    return tuple(found)


def _bulk_rows(placed: Placed, name: str) -> NDArray[np.float32] | None:
    """Of instances that were read in bulk, of which Blender says nothing."""
    counts = [np.asarray(matrices).size // 16 for matrices in placed.matrices]
    if not name.startswith(INSTANCER_PREFIX):
        one = _rows(replace(placed, matrices=[np.eye(4)]), name)
        return None if one is None else np.tile(np.array(one, np.float32), (sum(counts), 1))
    own, parts = name[len(INSTANCER_PREFIX) :], []
    for (instancer, attribute), count in zip(placed.bulk, counts, strict=True):
        values = attribute(own)
        if values is None:
            owners = (instancer, instancer.data, placed.item, placed.item.data)
            values = np.tile(np.array(property_of(owners, own), np.float32), (count, 1))
        parts.append(values)
    return np.concatenate(parts)


def _rows(placed: Placed, name: str) -> list[tuple[float, ...]] | None:
    count = len(placed.all_matrices())
    records: list[Record | None] = [*placed.records] or [None] * count
    if name.startswith((OBJECT_PREFIX, INSTANCER_PREFIX)):
        return [property_of((placed.item, placed.item.data), name.partition(":")[2])] * count
    if name.startswith(PARTICLE_PREFIX):
        return [particle_value(record, name[len(PARTICLE_PREFIX) :]) for record in records]
    if name == INSTANCER_GENERATED:
        return [(0.0,) * 3 if r is None else tuple(0.5 * v - 0.5 for v in r.generated) for r in records]
    if name == INSTANCER_UV:
        return [(0.0,) * 3 if r is None else (*r.uv, 0.0) for r in records]
    if name in (VOLUME_SCALE, VOLUME_OFFSET):
        scale, offset = texture_space(placed.item.data)
        return [tuple(scale if name == VOLUME_SCALE else offset)] * count
    return None


def _of_instance(placed: Placed, record: Record, name: str, made: GeometryInstances, notices: Notices) -> Rgba:
    """What comes first in Cycles: the settings of particles, geometry nodes, the instancer, the object."""
    own = _property_among((record.particles,), name)
    if own is not None:
        return own
    try:
        color = None if record.instancer is None else made.color(record.instancer, record.numbers, name)
        if color is not None:
            return color
    except LostError as why:
        what = f"its material asks for '{name}', which geometry nodes may give instances, but {why}"
        notices.add(place(placed.name), f"{what}; it is that of the objects, or 0")
    data = None if record.instancer is None else record.instancer.data
    return property_of((record.instancer, data, placed.item, placed.item.data), name)


def particle_value(record: Record | None, what: str) -> tuple[float, ...]:
    """By the name of a Particle Info node's output; 0 where there is no particle."""
    index = 0 if record is None else record.particle_index
    if what == "Index":
        return (float(index),)
    if what == "Random":
        return (hash_pair(index, 0) / 0xFFFFFFFF,)
    if record is not None and what in record.particle:
        return record.particle[what]
    return (0.0,) * 3 if what in ("Location", "Velocity", "Angular Velocity") else (0.0,)


def property_of(owners: tuple[Any, ...], name: str) -> Rgba:
    """The first of the owners' custom properties, or values by their path, of this name; black and clear for none."""
    found = _property_among(owners, name)
    return BLACK_AND_CLEAR if found is None else found


def _property_among(owners: tuple[Any, ...], name: str) -> Rgba | None:
    for owner in owners:
        found = None if owner is None else _rgba(_property(owner, name))
        if found is not None:
            return found
    return None


def _property(owner: bpy.types.ID, name: str) -> Any:
    if name in owner:
        return owner[name]
    try:
        return owner.path_resolve(name)
    except (ValueError, TypeError):
        return None


def _rgba(value: Any) -> Rgba | None:
    if isinstance(value, (bool, int, float)):
        return float(value), float(value), float(value), 1.0
    try:
        numbers = [float(v) for v in value]
    except (TypeError, ValueError):
        return None
    if not 1 <= len(numbers) <= 4:
        return None
    alpha = numbers[3] if len(numbers) == 4 else 1.0
    red, green, blue = [*numbers[:3], 0.0, 0.0][:3]
    return red, green, blue, alpha
