# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's meshes -> Mesh: everything is read in bulk, and only what the engine uses."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..scene.description import Floats, Mesh
from ..scene.problems import GlimmerError

if TYPE_CHECKING:
    import bpy

# Corner normals that differ by less are one: Blender stores custom normals in 16 bits.
NORMAL_TOLERANCE = 1e-4


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


def export_mesh(mesh: bpy.types.Mesh, name: str, slot_count: int = 1) -> Mesh | None:
    """None for a mesh without faces. Faces of slots that the object lacks use the last, as in Blender.

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
    normals = _corner_normals(mesh, corners)
    slots = read(triangles, "material_index", np.int32).clip(0, slot_count - 1)
    if normals is None:
        return _finish(name, vertices, corner_vertices[corners], None, slots)
    source, new_vertex = split_by_normal(corner_vertices, normals)
    return _finish(name, vertices[corner_vertices[source]], new_vertex[corners], normals[source], slots)


def _corner_normals(mesh: bpy.types.Mesh, corners: NDArray[np.int32]) -> Floats | None:
    """(corners, 3), zero on flat faces; None where all faces are flat."""
    smooth = read(mesh.polygons, "use_smooth", np.bool_)
    if not smooth.any() and not mesh.has_custom_normals:
        return None
    normals = read(mesh.loops, "normal", np.float32, 3)
    if not mesh.has_custom_normals and not smooth.all():
        polygon_of_triangle = read(mesh.loop_triangles, "polygon_index", np.int32)
        normals[corners[~smooth[polygon_of_triangle]].reshape(-1)] = 0.0
    normals[~np.isfinite(normals).all(axis=1)] = 0.0
    return normals


def _finish(
    name: str, vertices: Floats, triangles: NDArray[Any], normals: Floats | None, slots: NDArray[np.int32]
) -> Mesh:
    return Mesh(
        name=name,
        vertices=vertices,
        triangles=np.ascontiguousarray(triangles, np.uint32),
        normals=normals,
        slots=slots.astype(np.uint16) if slots.any() else None,
    )


def fit_sphere(vertices: Floats, name: str) -> tuple[Floats, float]:
    """Centre (3,) and radius of a mesh that approximates a sphere: its vertices lie on it.

    Least squares of |v|^2 = 2 c.v + (r^2 - |c|^2), exact for vertices of a sphere, wherever the mesh's origin is.
    """
    points = np.asarray(vertices, np.float64)
    middle = points.mean(axis=0)
    offsets = points - middle
    system = np.column_stack((2.0 * offsets, np.ones(len(offsets))))
    solution, _, rank, _ = np.linalg.lstsq(system, (offsets**2).sum(axis=1), rcond=None)
    center = solution[:3]
    distances = np.linalg.norm(offsets - center, axis=1)
    radius = float(distances.mean())
    if rank < 4 or not radius > 0.0 or float(np.abs(distances - radius).max()) > 0.01 * radius:
        raise GlimmerError(
            f"Object '{name}' is marked as an analytic sphere, but its mesh is none: its vertices must lie on a sphere"
        )
    return center + middle, radius
