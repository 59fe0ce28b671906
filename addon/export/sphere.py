# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes that are marked as analytic spheres -> Spheres, where they are spheres."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..scene.description import Floats
from .mesh import read

if TYPE_CHECKING:
    import bpy

# Of the radius: how far a vertex may lie from the sphere.
VERTEX_TOLERANCE = 0.01
# Of the radius: how near to the centre the plane of a face may come. A cube's come to 0.58, an icosahedron's to 0.79.
NEAREST_FACE = 0.7
# Of the full solid angle: what the faces may leave open, or cover twice.
OPEN = 0.01


class NotASphereError(Exception):
    """Why not: words that end a sentence on the object."""


@dataclass(frozen=True)
class FittedSphere:
    """In its object's space."""

    center: Floats  # (3,)
    radius: float

    def placed(self, matrices: Floats) -> tuple[Floats, Floats]:
        """Centres (n, 3) and radii (n,) under world matrices (n, 4, 4). Uneven scale raises NotASphereError."""
        scales = np.linalg.norm(matrices[:, :3, :3], axis=1)
        if (np.ptp(scales, axis=1) > 1e-3 * scales.max(axis=1)).any():
            raise NotASphereError("is scaled unevenly; scale it alike along x, y and z")
        return (matrices[:, :3, :3] * self.center).sum(axis=2) + matrices[:, :3, 3], self.radius * scales.mean(axis=1)


def read_sphere(item: bpy.types.Object) -> FittedSphere | None:
    """Of an evaluated object. None for a mesh without vertices; one that is no sphere raises NotASphereError."""
    mesh = item.to_mesh()
    try:
        if mesh is None or not len(mesh.vertices):
            return None
        mesh.calc_loop_triangles()
        points = read(mesh.vertices, "co", np.float32, 3)
        return fit_sphere(points, read(mesh.loop_triangles, "vertices", np.int32, 3))
    finally:
        item.to_mesh_clear()


def fit_sphere(vertices: Floats, triangles: NDArray[Any]) -> FittedSphere:
    """The sphere that a closed mesh approximates, wherever its origin is. Raises NotASphereError.

    Least squares of |v|^2 = 2 c.v + (r^2 - |c|^2), exact for vertices of a sphere. By the normal equations and by hand,
    since LAPACK's last bits depend on where arrays lie in memory, and a picture must not.
    """
    points = np.asarray(vertices, np.float64)
    middle = points.mean(axis=0)
    offsets = points - middle
    # Of offsets whose mean is 0 the constant term decouples: (2 sum o o^T) c = sum o |o|^2.
    squares = (offsets**2).sum(axis=1)
    moments = [[float((offsets[:, i] * offsets[:, j]).sum()) for j in range(3)] for i in range(3)]
    sums = [0.5 * float((offsets[:, i] * squares).sum()) for i in range(3)]
    solution = _solve(moments, sums)
    center = np.array(solution or [0.0, 0.0, 0.0])
    offsets = offsets - center
    distances = np.sqrt((offsets**2).sum(axis=1))
    radius = float(distances.mean())
    if solution is None or not radius > 0.0 or float(np.abs(distances - radius).max()) > VERTEX_TOLERANCE * radius:
        raise NotASphereError(f"is no sphere: its vertices do not lie within {VERTEX_TOLERANCE:.0%} of one")
    _expect_round(offsets / radius, triangles)
    return FittedSphere(center + middle, radius)


def _expect_round(points: Floats, triangles: NDArray[Any]) -> None:
    """Vertices on the unit sphere are a cube's too: the faces must follow it, and cover all of it once."""
    a, b, c = (points[triangles[:, corner]] for corner in range(3))
    normals = np.cross(b - a, c - a)
    volumes = (a * normals).sum(axis=1)  # a.(b x c)
    lengths = np.sqrt((normals**2).sum(axis=1))
    faces = lengths > 1e-6 * lengths.max(initial=0.0)
    if (np.abs(volumes[faces]) < NEAREST_FACE * lengths[faces]).any():
        raise NotASphereError("is no sphere, though its vertices lie on one: its faces are too coarse")
    # Van Oosterom and Strackee 1983, for corners at distance 1.
    angles = 2.0 * np.arctan2(volumes, 1.0 + (a * b).sum(axis=1) + (b * c).sum(axis=1) + (c * a).sum(axis=1))
    if abs(abs(float(angles.sum())) / (4.0 * pi) - 1.0) > OPEN:
        raise NotASphereError("is no whole sphere: its faces leave some of it open or cover it twice")


def _solve(matrix: list[list[float]], right: list[float]) -> list[float] | None:
    """A 3x3 system by Cramer's rule; None where it is singular for float64."""
    (a, b, c), (d, e, f), (g, h, i) = matrix
    determinant = a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)
    if abs(determinant) <= 1e-9 * max(abs(value) for row in matrix for value in row) ** 3:
        return None
    x, y, z = right
    return [
        (x * (e * i - f * h) - b * (y * i - f * z) + c * (y * h - e * z)) / determinant,
        (a * (y * i - f * z) - x * (d * i - f * g) + c * (d * z - y * g)) / determinant,
        (a * (e * z - y * h) - b * (d * z - y * g) + x * (d * h - e * g)) / determinant,
    ]
