# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes to measure in: radiometers, plates, boxes, balls."""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from addon.scene import description as d

Array = NDArray[Any]
Vector = tuple[float, float, float]
BLACK, WHITE = d.BLACK, d.WHITE


def grey(value: float) -> d.Rgb:
    return (value, value, value)


def unit(v: ArrayLike) -> Array:
    a = np.asarray(v, np.float64)
    return a / np.linalg.norm(a)


def at(theta: float, azimuth: float = 0.4) -> Array:
    """A unit vector at theta from +z."""
    return np.array([np.sin(theta) * np.cos(azimuth), np.sin(theta) * np.sin(azimuth), np.cos(theta)])


def look_at(origin: ArrayLike, target: ArrayLike, up: Vector = (0, 0, 1)) -> Array:
    """(4, 4): a camera at `origin` that looks at `target`."""
    o = np.asarray(origin, np.float64)
    back = unit(o - np.asarray(target, np.float64))
    reference = np.asarray(up) if abs(back @ unit(up)) < 0.999 else np.array([0.0, 1.0, 0.0])
    right = unit(np.cross(reference, back))
    matrix = np.eye(4)
    matrix[:3, :3] = np.stack([right, np.cross(back, right), back], axis=1)
    matrix[:3, 3] = o
    return matrix


def camera(origin: ArrayLike, target: ArrayLike, fov: float) -> d.Camera:
    return d.Camera(to_world=look_at(origin, target), projection=d.Perspective(fov))


def radiometer(origin: ArrayLike, target: ArrayLike) -> d.Camera:
    """A camera so narrow (1e-4 radians) that its picture holds the radiance along its axis: what is odd in the angle
    cancels, what is even is off by 1e-8."""
    return camera(origin, target, np.degrees(1e-4))


def quad(center: ArrayLike, u: ArrayLike, v: ArrayLike, name: str = "quad") -> d.Mesh:
    """A parallelogram center +- u +- v; its normal is u x v."""
    c, u, v = (np.asarray(a, np.float64) for a in (center, u, v))
    return d.Mesh(
        name, np.array([c - u - v, c + u - v, c + u + v, c - u + v]), np.array([[0, 1, 2], [0, 2, 3]], np.uint32)
    )


def floor(z: float = 0, half: float = 2, center: tuple[float, float] = (0, 0)) -> d.Mesh:
    """A horizontal plate, its normal up. Its diagonal runs beside the centre, not through it."""
    return quad((center[0] + 0.1 * half, center[1], z), (half, 0, 0), (0, half, 0))


def box(low: ArrayLike, high: ArrayLike, name: str = "box") -> d.Mesh:
    """A closed box, normals outward."""
    a, b = np.asarray(low, np.float64), np.asarray(high, np.float64)
    corners = np.array([[(a, b)[i >> k & 1][k] for k in range(3)] for i in range(8)])
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    triangles = [t for f in faces for t in ((f[0], f[1], f[2]), (f[0], f[2], f[3]))]
    return d.Mesh(name, corners, np.array(triangles, np.uint32))


def faces_apart(mesh: d.Mesh) -> d.Mesh:
    """The same with vertices of their own for each triangle."""
    return d.Mesh(
        mesh.name, mesh.vertices[mesh.triangles.ravel()], np.arange(mesh.triangles.size, dtype=np.uint32).reshape(-1, 3)
    )


def octahedron(center: ArrayLike, radius: float, splits: int = 0) -> d.Mesh:
    """A closed convex body, normals outward; each split cuts the edges in two and pushes out to the sphere."""
    v = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], np.float64)
    t = [(i, j, k) for i, j in ((0, 2), (2, 1), (1, 3), (3, 0)) for k in (4,)]
    t += [(j, i, 5) for i, j, _ in t]
    for _ in range(splits):
        vertices, triangles = [tuple(p) for p in v], []
        for a, b, c in t:
            middles = []
            for i, j in ((a, b), (b, c), (c, a)):
                vertices.append(tuple(unit(v[i] + v[j])))
                middles.append(len(vertices) - 1)
            ab, bc, ca = middles
            triangles += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        v, t = np.array(vertices), triangles
    return d.Mesh("ball", np.asarray(center) + radius * v, np.array(t, np.uint32))


def hexagon(radius: float, thickness: float) -> d.Mesh:
    """A closed hexagonal plate, its top at z = 0."""
    angle = np.arange(6) * np.pi / 3
    ring = radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    vertices = np.concatenate([np.c_[ring, np.zeros(6)], np.c_[ring, np.full(6, -thickness)]])
    triangles = [(0, i, i + 1) for i in range(1, 5)] + [(6, 7 + i, 6 + i) for i in range(1, 5)]
    for i in range(6):
        j = (i + 1) % 6
        triangles += [(i, 6 + i, 6 + j), (i, 6 + j, j)]
    return d.Mesh("hexagon", vertices, np.array(triangles, np.uint32))


class Builder:
    """Collects the parts of a scene."""

    def __init__(self, view: d.Camera, width: int = 16, height: int = 16, **parts: Any) -> None:
        """parts: the other fields of SceneDescription."""
        self._film = d.Film(width, height)
        self._camera = view
        self._parts = parts
        self._materials: list[d.NamedMaterial] = []
        self._objects: list[d.Object] = []
        self._spheres: list[d.Spheres] = []
        self._lights: list[d.Lamp] = []

    def seen_by(self, view: d.Camera, film: d.Film) -> "Builder":
        self._camera, self._film = view, film
        return self

    def material(self, material: d.Material) -> int:
        self._materials.append(d.NamedMaterial(f"material {len(self._materials)}", material))
        return len(self._materials) - 1

    def mesh(
        self,
        mesh: d.Mesh,
        material: d.Material,
        instances: Array | None = None,
        motion: Array | None = None,
        interior: d.Medium | None = None,
    ) -> "Builder":
        number = self.material(material)
        self._objects.append(
            d.Object(mesh.name, mesh, (number,), instances=instances, motion=motion, interior=interior)
        )
        return self

    def sphere(
        self, center: ArrayLike, radius: float, material: d.Material, interior: d.Medium | None = None
    ) -> "Builder":
        return self.spheres(np.atleast_2d(np.asarray(center, np.float64)), np.array([radius]), material, interior)

    def spheres(
        self, centers: Array, radii: Array, material: d.Material, interior: d.Medium | None = None
    ) -> "Builder":
        self._spheres.append(d.Spheres("spheres", centers, radii, self.material(material), interior=interior))
        return self

    def hide(self, rays: d.Rays) -> "Builder":
        """Makes all surfaces so far ones that only these rays meet."""
        self._objects = [replace(item, rays=rays) for item in self._objects]
        self._spheres = [replace(item, rays=rays) for item in self._spheres]
        return self

    def lamp(self, lamp: d.Lamp) -> "Builder":
        self._lights.append(lamp)
        return self

    def done(self) -> d.SceneDescription:
        return d.SceneDescription(
            self._film,
            self._camera,
            tuple(self._materials),
            tuple(self._objects),
            tuple(self._spheres),
            tuple(self._lights),
            **self._parts,
        )


def sky(radiance: float = 1) -> d.Environment:
    return d.Environment(grey(radiance))
