# SPDX-License-Identifier: GPL-3.0-or-later
"""Hair of particle systems and hair curves -> meshes of tubes.

The engine has no curves. A tube has the sides that a ribbon's rounded normals pretend, and is as wide as the round one
on average over all directions.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import chain
from math import pi, sin
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..scene.description import Attribute, Floats, Mesh
from . import affine
from .attributes import FIELDS, is_known
from .instance import hash_pair
from .translate.surface import ACTIVE_UV, GENERATED, STRAND_PREFIX, STRAND_TANGENT, named

if TYPE_CHECKING:
    import bpy

MOST_TRIANGLES = 5_000_000  # of the hair of one particle system or curves object
# Sides of a tube and parts of a segment (Cycles' curves are smooth between their points), as far as that bound allows.
FINENESS = ((12, 3), (12, 2), (8, 2), (8, 1), (6, 1), (4, 1), (3, 1))
LEAST_SMOOTH = 6  # sides; the normals of fewer turn so much within a face that light is lost
GOLDEN = 0.5 * (5.0**0.5 - 1.0)  # whose multiples are spread evenly, modulo 1
DEFAULT_RADIUS = 0.005  # of curves without radii; Cycles' own


@dataclass(frozen=True, eq=False)
class Strands:
    """Curves in the space of their object."""

    points: Floats  # (n, 3), strand after strand
    radii: Floats  # (n,)
    counts: NDArray[np.integer]  # (s,): points of each strand, 2 or more
    slot: int = 0  # of the object's materials
    values: tuple[tuple[str, Floats], ...] = ()  # what programs ask for by name, (s, width) of each strand
    along: tuple[tuple[str, Floats], ...] = ()  # and (n, width) of each point

    @property
    def segments(self) -> int:
        return len(self.points) - len(self.counts)


@dataclass(frozen=True, eq=False)
class Tubes:
    mesh: Mesh
    kept: float  # the part of the strands; the rest is left out, and these are wider for it
    each: int  # of how many points of a strand one is left


# ---- From Blender ------------------------------------------------------------------------------------------------


def particle_strands(item: bpy.types.Object, is_final: bool, names: frozenset[str]) -> list[Strands]:
    """Of an evaluated object, a Strands for each of its particle systems that shows hair. names: of attributes."""
    inverse = affine.inverse(np.array(item.matrix_world, np.float64))
    found: list[Strands] = []
    for modifier in item.modifiers:
        if modifier.type != "PARTICLE_SYSTEM":
            continue
        if not (modifier.show_render if is_final else modifier.show_viewport):
            continue
        settings = modifier.particle_system.settings
        if settings.type == "HAIR" and settings.render_type == "PATH":
            before = sum(len(strands.counts) for strands in found)
            strands = _system_strands(item, modifier, inverse, is_final, names, before)
            if strands is not None:
                found.append(strands)
    return found


def _system_strands(
    item: bpy.types.Object, modifier: Any, inverse: Floats, is_final: bool, names: frozenset[str], before: int
) -> Strands | None:
    """before: how many strands the systems before it have."""
    system = modifier.particle_system
    settings = system.settings
    parents, children = len(system.particles), len(system.child_particles)
    if not is_final:
        children = int(children * settings.display_percentage / 100.0)
    # Children take their parents' place.
    first = 0 if settings.child_type == "NONE" or children == 0 else parents
    numbers = range(first, parents + children)
    steps = 2 ** (settings.render_step if is_final else settings.display_step) + 1
    if settings.kink == "SPIRAL":
        steps += settings.kink_extra_steps
    # fromiter, since np.array takes four times as long for a list of vectors as Blender for making them.
    places = (system.co_hair(item, particle_no=number, step=step) for number in numbers for step in range(steps))
    points: Floats = np.fromiter(chain.from_iterable(places), np.float64).reshape(-1, steps, 3)
    if not len(points):
        return None
    points = points @ inverse[:3, :3].T + inverse[:3, 3]
    lengths = np.zeros(points.shape[:2])
    lengths[:, 1:] = np.cumsum(np.linalg.norm(np.diff(points, axis=1), axis=2), axis=1)
    grown = lengths[:, -1] > 0.0
    if not grown.any():
        return None
    radii = profile(lengths[grown] / lengths[grown][:, -1:], settings)
    values = _root_values(item, modifier, numbers, points[:, 0], names)
    found = Strands(
        points[grown].reshape(-1, 3),
        radii.reshape(-1),
        np.full(int(grown.sum()), steps),
        max(settings.material - 1, 0),
        tuple((name, rows[grown]) for name, rows in values),
    )
    return with_info(found, names, before)


def profile(along: Floats, settings: Any) -> Floats:
    """(s, k) radii at the parts (s, k) of strands' lengths, 0 at the root and 1 at the tip."""
    falling = 1.0 - np.clip(along, 0.0, 1.0)
    shape = settings.shape
    if shape != 0.0:
        falling = falling ** (1.0 + shape if shape < 0.0 else 1.0 / max(1.0 - shape, 1e-6))
    # What Blender calls radii are diameters to Cycles.
    root, tip = (0.5 * value * settings.radius_scale for value in (settings.root_radius, settings.tip_radius))
    radii: Floats = falling * (root - tip) + tip
    if settings.use_close_tip:
        radii[:, -1] = 0.0
    return radii


def _root_values(
    item: bpy.types.Object, modifier: Any, numbers: range, roots: Floats, names: frozenset[str]
) -> list[tuple[str, Floats]]:
    """What a surface has at the strands' roots: generated coordinates and texture coordinates."""
    system, found = modifier.particle_system, []
    for name in sorted(names):
        if name == GENERATED:
            location = np.array(item.data.texspace_location, np.float64)
            size = np.array(item.data.texspace_size, np.float64)
            inverse = np.where(size != 0.0, 0.5 / np.where(size != 0.0, size, 1.0), 0.0)
            found.append((name, (roots - location) * inverse + 0.5))
            continue
        layers = item.data.uv_layers
        number = next(
            (
                index
                for index, layer in enumerate(layers)
                if (layer.active_render if name == ACTIVE_UV else named(layer.name) == name)
            ),
            None,
        )
        if number is not None:
            particles, last = system.particles, len(system.particles) - 1
            rows = [
                system.uv_on_emitter(modifier, particle=particles[min(n, last)], particle_no=n, uv_no=number)
                for n in numbers
            ]
            found.append((name, np.array(rows, np.float64)))
    return found


def curve_strands(curves: bpy.types.Curves, names: frozenset[str] = frozenset()) -> Strands | None:
    """Of the data of a hair curves object, or of curves that Geometry Nodes made. names: of attributes."""
    count = len(curves.points)
    if not count:
        return None
    points = np.empty(3 * count, np.float32)
    curves.points.foreach_get("position", points)
    radii = np.full(count, DEFAULT_RADIUS, np.float32)
    own = curves.attributes.get("radius")
    if own is not None and own.domain == "POINT" and own.data_type == "FLOAT":
        own.data.foreach_get("value", radii)
    counts = np.empty(len(curves.curves), np.int32)
    curves.curves.foreach_get("points_length", counts)
    long = counts >= 2
    keep = np.repeat(long, counts)
    if not keep.any():
        return None
    asked = [item for item in curves.attributes if named(item.name) in names and is_known(item.data_type)]
    found = Strands(
        points.reshape(-1, 3)[keep].astype(np.float64),
        radii[keep].astype(np.float64),
        counts[long],
        values=tuple((named(item.name), _curve_values(item)[long]) for item in asked if item.domain == "CURVE"),
        along=tuple((named(item.name), _curve_values(item)[keep]) for item in asked if item.domain == "POINT"),
    )
    return with_info(found, names)


def with_info(strands: Strands, names: frozenset[str], before: int = 0) -> Strands:
    """With what a Curves Info node shows, where names ask for it. before: strands that were counted already."""
    starts = _starts(strands)
    steps = np.zeros(len(strands.points))
    steps[1:] = np.linalg.norm(np.diff(strands.points, axis=0), axis=1)
    steps[starts] = 0.0
    travelled = np.cumsum(steps)
    travelled -= np.repeat(travelled[starts], strands.counts)
    lengths = travelled[starts + strands.counts - 1]
    each = np.repeat(lengths, strands.counts)
    of_strands = {
        "Is Strand": np.ones(len(lengths)),
        "Length": lengths,
    }
    if STRAND_PREFIX + "Random" in names:
        of_strands["Random"] = np.array([hash_pair(before + i, 0) for i in range(len(lengths))]) / 0xFFFFFFFF
    of_points = {
        "Intercept": travelled / np.where(each > 0.0, each, 1.0),
        "Thickness": 2.0 * strands.radii,
    }
    values = tuple(
        (STRAND_PREFIX + key, rows[:, None]) for key, rows in of_strands.items() if STRAND_PREFIX + key in names
    )
    along = tuple(
        (STRAND_PREFIX + key, rows[:, None]) for key, rows in of_points.items() if STRAND_PREFIX + key in names
    )
    if STRAND_TANGENT in names:
        along += ((STRAND_TANGENT, tangents_along(strands.points, strands.counts)),)
    return replace(strands, values=strands.values + values, along=strands.along + along)


def _curve_values(attribute: Any) -> Floats:
    """(curves or points, width) of an attribute."""
    field, width = FIELDS[attribute.data_type]
    kinds: dict[str, type[np.generic]] = {"INT": np.int32, "INT8": np.int32, "BOOLEAN": np.bool_}
    values: NDArray[Any] = np.empty(width * len(attribute.data), kinds.get(attribute.data_type, np.float32))
    attribute.data.foreach_get(field, values)
    return values.reshape(-1, width).astype(np.float64)


# ---- To tubes ----------------------------------------------------------------------------------------------------


def tubes(name: str, strands: Strands) -> Tubes:
    """One mesh of all strands, within MOST_TRIANGLES."""
    kept, each = 1.0, 1
    fewest = FINENESS[-1]
    while 2 * fewest[0] * strands.segments > MOST_TRIANGLES and strands.counts.max() > 3:
        strands, each = _coarsened(strands), 2 * each
    if 2 * fewest[0] * strands.segments > MOST_TRIANGLES:
        most = MOST_TRIANGLES * len(strands.counts) / (2 * fewest[0] * strands.segments)
        before = len(strands.counts)
        strands = _thinned(strands, max(int(most), 1))
        kept = len(strands.counts) / before
    fits = (level for level in FINENESS if 2 * level[0] * level[1] * strands.segments <= MOST_TRIANGLES)
    sides, parts = next(fits, fewest)
    return Tubes(_mesh(name, subdivided(strands, parts), sides), kept, each)


def _coarsened(strands: Strands) -> Strands:
    """Every second point of each strand, and its last."""
    starts = _starts(strands)
    keep = (np.arange(len(strands.points)) - np.repeat(starts, strands.counts)) % 2 == 0
    keep[starts + strands.counts - 1] = True
    return replace(
        strands,
        points=strands.points[keep],
        radii=strands.radii[keep],
        counts=np.add.reduceat(keep.astype(np.intp), starts),
        along=tuple((name, rows[keep]) for name, rows in strands.along),
    )


def _starts(strands: Strands) -> NDArray[np.integer]:
    return np.cumsum(strands.counts) - strands.counts


def _thinned(strands: Strands, most: int) -> Strands:
    """At most so many strands, evenly picked, and wider in turn."""
    chosen = np.zeros(len(strands.counts), bool)
    chosen[np.linspace(0, len(chosen) - 1, most).round().astype(int)] = True
    keep = np.repeat(chosen, strands.counts)
    return replace(
        strands,
        points=strands.points[keep],
        radii=strands.radii[keep] * (len(chosen) / chosen.sum()),
        counts=strands.counts[chosen],
        values=tuple((name, rows[chosen]) for name, rows in strands.values),
        along=tuple((name, rows[keep]) for name, rows in strands.along),
    )


def subdivided(strands: Strands, parts: int) -> Strands:
    """Each segment in so many, on the Catmull-Rom curve through the points."""
    if parts == 1:
        return strands
    points = np.concatenate([strands.points, strands.radii[:, None]], axis=1)
    starts = _starts(strands)
    ends = starts + strands.counts - 1
    is_end = np.zeros(len(points), bool)
    is_end[ends] = True
    b = np.flatnonzero(~is_end)  # the first point of each segment
    before = np.maximum(b - 1, np.repeat(starts, strands.counts - 1))
    after = np.minimum(b + 2, np.repeat(ends, strands.counts - 1))
    p0, p1, p2, p3 = points[before], points[b], points[b + 1], points[after]
    t = (np.arange(parts) / parts)[None, :, None]
    p0, p1, p2, p3 = (p[:, None] for p in (p0, p1, p2, p3))
    inner = 0.5 * (
        2.0 * p1 + (p2 - p0) * t + (2.0 * p0 - 5.0 * p1 + 4.0 * p2 - p3) * t**2 + (3.0 * (p1 - p2) + p3 - p0) * t**3
    )
    counts = (strands.counts - 1) * parts + 1
    result = np.empty((int(counts.sum()), 4))
    last = np.cumsum(counts) - 1
    rest = np.ones(len(result), bool)
    rest[last] = False
    result[rest], result[last] = inner.reshape(-1, 4), points[ends]
    part = (np.arange(parts) / parts)[None, :, None]

    def spread(rows: Floats) -> Floats:
        """Along straight lines, as Cycles has them."""
        finer = np.empty((len(result), rows.shape[1]))
        finer[rest] = (rows[b][:, None] + (rows[b + 1] - rows[b])[:, None] * part).reshape(-1, rows.shape[1])
        finer[last] = rows[ends]
        return finer

    return replace(
        strands,
        points=result[:, :3],
        radii=np.maximum(result[:, 3], 0.0),
        counts=counts,
        along=tuple((name, spread(rows)) for name, rows in strands.along),
    )


def _mesh(name: str, strands: Strands, sides: int) -> Mesh:
    counts, n = strands.counts, len(strands.points)
    ends = np.cumsum(counts) - 1
    across = _frames(strands.points, counts)
    angles = 2.0 * pi * np.arange(sides) / sides
    normals = across[:, 0, None] * np.cos(angles)[None, :, None] + across[:, 1, None] * np.sin(angles)[None, :, None]
    # The mean width of a convex outline is its length over pi: that of the polygon is to be the circle's.
    widened = pi / (sides * sin(pi / sides))
    least = 1e-3 * max(float(strands.radii.max()), 1e-12)  # no triangle without an area
    vertices = strands.points[:, None] + normals * (widened * np.maximum(strands.radii, least))[:, None, None]
    begins = np.ones(n, bool)
    begins[ends] = False
    ring = np.flatnonzero(begins)[:, None] * sides
    a, b = ring + np.arange(sides), ring + (np.arange(sides) + 1) % sides
    triangles = np.stack([a, b, b + sides, a, b + sides, a + sides], axis=2).reshape(-1, 3)
    rows = np.repeat(np.arange(len(counts)), (counts - 1) * 2 * sides)
    return Mesh(
        name,
        vertices.reshape(-1, 3).astype(np.float32),
        triangles.astype(np.uint32),
        normals.reshape(-1, 3).astype(np.float32) if sides >= LEAST_SMOOTH else None,
        attributes=tuple(
            Attribute(key, "face", np.ascontiguousarray(values[rows], np.float32)) for key, values in strands.values
        )
        + tuple(
            Attribute(key, "vertex", np.repeat(values, sides, axis=0).astype(np.float32))
            for key, values in strands.along
        ),
    )


def _frames(points: Floats, counts: NDArray[np.integer]) -> Floats:
    """(n, 2, 3): two directions across each point's strand, carried along it with as little turn as can be. They begin
    at an angle of each strand's own: sides that faced the same ways on all would be too bright or too dark together."""
    starts = np.cumsum(counts) - counts
    along = tangents_along(points, counts)
    result = np.empty((len(points), 2, 3))
    first = along[starts]
    axes = np.eye(3)[np.abs(first).argmin(axis=1)]
    current = _unit(axes - first * (axes * first).sum(axis=1, keepdims=True))
    turn = 2.0 * pi * (GOLDEN * np.arange(len(starts)) % 1.0)[:, None]
    current = np.cos(turn) * current + np.sin(turn) * np.cross(first, current)
    alive = np.arange(len(starts))
    for step in range(int(counts.max())):
        alive = alive[counts[alive] > step]
        here = starts[alive] + step
        t = along[here]
        moved = current[alive] - t * (current[alive] * t).sum(axis=1, keepdims=True)
        lost = (moved**2).sum(axis=1) < 1e-12  # the strand turned by 90 degrees, into what was across it
        moved[lost] = np.cross(t[lost], np.eye(3)[np.abs(t[lost]).argmin(axis=1)])
        current[alive] = _unit(moved)
        result[here, 0], result[here, 1] = current[alive], np.cross(t, current[alive])
    return result


def tangents_along(points: Floats, counts: NDArray[np.integer]) -> Floats:
    """(n, 3): unit vectors along the strand of each point."""
    segments = np.diff(points, axis=0, append=points[-1:])
    inner = np.ones(len(points), bool)
    inner[np.cumsum(counts) - 1] = False
    segments = np.where(inner[:, None], _unit(segments), 0.0)
    behind = np.concatenate([np.zeros((1, 3)), segments[:-1]])
    along = _unit(segments + behind)
    along[(along == 0.0).all(axis=1)] = (0.0, 0.0, 1.0)
    return along


def _unit(vectors: Floats) -> Floats:
    lengths = np.sqrt((vectors**2).sum(axis=-1, keepdims=True))
    return vectors / np.where(lengths > 0.0, lengths, 1.0)
