# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's meshes -> Mesh: everything is read in bulk, and only what the engine uses."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..scene.description import Floats, Mesh
from ..scene.problems import GlimmerError
from .attributes import AttributeReader

if TYPE_CHECKING:
    import bpy

# Corner normals that differ by less are one: Blender stores custom normals in 16 bits.
NORMAL_TOLERANCE = 1e-4
SMOOTHED_FROM, SMOOTHED_UNTIL = (4, 2), (5, 2)


def read(collection: Any, name: str, kind: type[np.generic], components: int = 1) -> NDArray[Any]:
    """One attribute of every item of a Blender collection, (n,) or (n, components)."""
    values = np.empty(len(collection) * components, kind)
    collection.foreach_get(name, values)
    return values if components == 1 else values.reshape(-1, components)


def split_by_normal(
    corner_vertices: NDArray[np.integer], corner_normals: Floats
) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """The fewest vertices that give every corner its normal.

    corner_vertices (c,), corner_normals (c, 3). Returns the corner that each new vertex is copied from (n,), and the
    new vertex of each corner (c,).
    """
    rounded = np.round(corner_normals / NORMAL_TOLERANCE).astype(np.int64) + 2**20
    packed = (rounded[:, 0] << 42) | (rounded[:, 1] << 21) | rounded[:, 2]
    order = np.lexsort((packed, corner_vertices))
    vertices, keys = corner_vertices[order], packed[order]
    first = np.ones(len(order), bool)
    first[1:] = (vertices[1:] != vertices[:-1]) | (keys[1:] != keys[:-1])
    new_vertex = np.empty(len(order), np.intp)
    new_vertex[order] = np.cumsum(first) - 1
    return order[first], new_vertex


def doubled_faces(mesh: Mesh) -> int:
    """How many triangles have the corners of others."""
    words = np.ascontiguousarray(mesh.vertices, np.float32).view(np.uint32).astype(np.uint64)
    primes = np.array([0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9], np.uint64)
    places = (words * primes).sum(axis=1, dtype=np.uint64)
    places ^= places >> np.uint64(29)
    places *= np.uint64(0xBF58476D1CE4E5B9)
    places ^= places >> np.uint64(32)
    corners = places[mesh.triangles]
    keys = corners.sum(axis=1, dtype=np.uint64) + corners[:, 0] * corners[:, 1] * corners[:, 2]
    return len(keys) - len(np.unique(keys))


def turned_faces(mesh: Mesh) -> int:
    """How many triangles have a normal at a corner that faces away from them, by more than what rounding may do."""
    if mesh.normals is None:
        return 0
    corners = np.asarray(mesh.vertices, np.float64)[mesh.triangles]
    across = _unit(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    cosines = np.einsum("tci,ti->tc", mesh.normals[mesh.triangles], across)
    return int((cosines < -0.01).any(axis=1).sum())


def export_mesh(
    mesh: bpy.types.Mesh,
    name: str,
    slot_count: int = 1,
    attributes: frozenset[str] = frozenset(),
    vertex_groups: tuple[str, ...] = (),
) -> Mesh | None:
    """None for a mesh without faces. Faces of slots that the object lacks use the last, as in Blender.

    attributes: names of those that shader programs ask for (see translate.surface); the mesh may lack them.
    vertex_groups: the names of its object's.

    Raises GlimmerError for a mesh that cannot be read."""
    if hasattr(mesh, "calc_normals_split"):  # before 4.1; later versions have corner normals at all times
        mesh.calc_normals_split()
    mesh.calc_loop_triangles()
    triangles = mesh.loop_triangles
    if not len(triangles):
        return None
    vertices = read(mesh.vertices, "co", np.float32, 3)
    corners = read(triangles, "loops", np.int32, 3)
    corner_vertices = read(mesh.loops, "vertex_index", np.int32)
    if not np.isfinite(vertices).all():
        bad = int(np.flatnonzero(~np.isfinite(vertices).all(axis=1))[0])
        raise GlimmerError(f"Mesh '{name}' cannot be read: vertex {bad} has a coordinate that is not a finite number")
    if corner_vertices.min() < 0 or corner_vertices.max() >= len(vertices):
        raise GlimmerError(f"Mesh '{name}' cannot be read: it uses vertices that it does not have; validate() mends it")
    slots = read(triangles, "material_index", np.int32).clip(0, slot_count - 1)
    slots_or_none = slots.astype(np.uint16) if slots.any() else None
    reader = AttributeReader(mesh, corners, corner_vertices, vertex_groups)
    read_attributes = reader.read(attributes) if attributes else ()
    if _is_smooth_throughout(mesh):
        normals = smooth_normals(vertices, corner_vertices, *_faces(mesh))
        return Mesh(name, vertices, corner_vertices[corners].astype(np.uint32), normals, slots_or_none, read_attributes)
    corner_normals = _corner_normals(mesh, corners, vertices, corner_vertices)
    if corner_normals is None:
        return Mesh(name, vertices, corner_vertices[corners].astype(np.uint32), None, slots_or_none, read_attributes)
    source, new_vertex = split_by_normal(corner_vertices, corner_normals)
    triangle_vertices = new_vertex[corners].astype(np.uint32)
    return Mesh(
        name,
        vertices[corner_vertices[source]],
        triangle_vertices,
        corner_normals[source],
        slots_or_none,
        read_attributes,
    )


def flattened(mesh: Mesh, to_world: Floats) -> Mesh:
    """In the world, under a matrix that leaves no volume. Its faces are flat."""
    vertices = np.asarray(mesh.vertices, np.float64) @ to_world[:3, :3].T + to_world[:3, 3]
    return replace(mesh, vertices=vertices.astype(np.float32), normals=None)


def _is_smooth_throughout(mesh: bpy.types.Mesh) -> bool:
    """Whether every vertex has one normal, that of all its faces."""
    if mesh.has_custom_normals or getattr(mesh, "use_auto_smooth", False):
        return False
    if not read(mesh.polygons, "use_smooth", np.bool_).all():
        return False
    # Before 4.1 edges are sharp under auto smooth alone.
    return hasattr(mesh, "use_auto_smooth") or not read(mesh.edges, "use_edge_sharp", np.bool_).any()


def _faces(mesh: bpy.types.Mesh) -> tuple[NDArray[np.int32], NDArray[np.int32], Floats]:
    polygons = mesh.polygons
    starts, totals = read(polygons, "loop_start", np.int32), read(polygons, "loop_total", np.int32)
    return starts, totals, read(polygons, "normal", np.float32, 3)


def smooth_normals(
    vertices: Floats,
    corner_vertices: NDArray[np.integer],
    starts: NDArray[np.integer],
    totals: NDArray[np.integer],
    face_normals: Floats,
) -> Floats:
    """Blender's vertex normals, (n, 3) float32: those of the faces, weighed by their angles at the vertex.

    starts, totals: first corner and count of corners of each face. Blender adds them up in parallel and in any order,
    so that the last bits of its own differ from one time to the next, and with them those of the picture.
    """
    order = np.argsort(starts, kind="stable")  # faces lie in the order of their corners, one after another
    starts, totals, face_normals = starts[order], totals[order], face_normals[order]
    corner = np.arange(len(corner_vertices))
    face_of_corner = np.repeat(np.arange(len(starts)), totals)
    first, last = starts[face_of_corner], (starts + totals - 1)[face_of_corner]
    points = np.asarray(vertices, np.float64)[corner_vertices]
    ahead = _unit(points[np.where(corner == last, first, corner + 1)] - points)
    behind = _unit(points[np.where(corner == first, last, corner - 1)] - points)
    angles = np.arccos(np.clip((ahead * behind).sum(axis=1), -1.0, 1.0))
    weighed = np.asarray(face_normals, np.float64)[face_of_corner] * angles[:, None]
    sums = [np.bincount(corner_vertices, weighed[:, axis], len(vertices)) for axis in range(3)]
    return _unit(np.stack(sums, axis=1)).astype(np.float32)


def _unit(vectors: Floats) -> Floats:
    """(n, 3) of length 1; a vector of length 0 stays."""
    lengths = np.sqrt((vectors**2).sum(axis=1, keepdims=True))
    return vectors / np.where(lengths > 0.0, lengths, 1.0)


def _is_smoothed_over_flat_faces(mesh: bpy.types.Mesh) -> bool:
    """Whether Cycles shades smooth faces as if those beside them which are flat were smooth too."""
    import bpy

    if mesh.has_custom_normals or not SMOOTHED_FROM <= bpy.app.version < SMOOTHED_UNTIL:
        return False
    return not read(mesh.edges, "use_edge_sharp", np.bool_).any()


def _corner_normals(
    mesh: bpy.types.Mesh, corners: NDArray[np.int32], vertices: Floats, corner_vertices: NDArray[np.int32]
) -> Floats | None:
    """(corners, 3), zero on flat faces; None where all faces are flat."""
    smooth = read(mesh.polygons, "use_smooth", np.bool_)
    if not smooth.any() and not mesh.has_custom_normals:
        return None
    if _is_smoothed_over_flat_faces(mesh):
        normals = smooth_normals(vertices, corner_vertices, *_faces(mesh))[corner_vertices]
    else:
        normals = read(mesh.loops, "normal", np.float32, 3)
    if not mesh.has_custom_normals and not smooth.all():
        polygon_of_triangle = read(mesh.loop_triangles, "polygon_index", np.int32)
        normals[corners[~smooth[polygon_of_triangle]].reshape(-1)] = 0.0
    normals[~np.isfinite(normals).all(axis=1)] = 0.0
    return normals
