# SPDX-License-Identifier: GPL-3.0-or-later
"""The same scene elsewhere, turned, or of another size: its picture is the same."""

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from addon.scene import description as d


def rotation(axis: ArrayLike, degrees: float) -> NDArray[np.float64]:
    """(3, 3), by Rodrigues' formula."""
    a = np.asarray(axis, np.float64)
    a = a / np.linalg.norm(a)
    k = np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])
    t = np.radians(degrees)
    result: NDArray[np.float64] = np.eye(3) + np.sin(t) * k + (1 - np.cos(t)) * (k @ k)
    return result


def similar(
    scene: d.SceneDescription,
    *,
    turn: NDArray[np.float64] | None = None,
    scale: float = 1,
    offset: ArrayLike = (0, 0, 0),
    in_vertices: bool = False,
) -> d.SceneDescription:
    """x -> scale turn x + offset, with the fog's coefficients and the lamps' powers as they must be for the same
    radiances. in_vertices: meshes are moved by their vertices, not by their objects' matrices."""
    r = np.eye(3) if turn is None else turn
    shift = np.asarray(offset, np.float64)
    whole = np.eye(4)
    whole[:3, :3], whole[:3, 3] = scale * r, shift

    def place(point: ArrayLike) -> NDArray[np.float64]:
        result: NDArray[np.float64] = scale * (r @ np.asarray(point, np.float64)) + shift
        return result

    def rigid(matrix: d.Floats) -> NDArray[np.float64]:
        m = np.eye(4)
        m[:3, :3], m[:3, 3] = r @ matrix[:3, :3], place(matrix[:3, 3])
        return m

    def moved(item: d.Object) -> d.Object:
        if not in_vertices or item.instances is not None:
            return replace(item, to_world=whole @ item.to_world)
        vertices = (np.c_[item.mesh.vertices, np.ones(len(item.mesh.vertices))] @ (whole @ item.to_world).T)[:, :3]
        return replace(item, mesh=replace(item.mesh, vertices=vertices), to_world=np.eye(4))

    def power(color: d.Rgb) -> d.Rgb:
        return (color[0] * scale**2, color[1] * scale**2, color[2] * scale**2)

    def vector(v: NDArray[np.float64]) -> tuple[float, float, float]:
        return (float(v[0]), float(v[1]), float(v[2]))

    def lamp(light: d.Lamp) -> d.Lamp:
        if isinstance(light, d.SunLight):
            return replace(light, direction=vector(r @ np.asarray(light.direction)))
        if isinstance(light, d.AreaLight):
            return replace(light, to_world=rigid(light.to_world), size=(light.size[0] * scale, light.size[1] * scale))
        light = replace(
            light, position=vector(place(light.position)), intensity=power(light.intensity), radius=light.radius * scale
        )
        if isinstance(light, d.SpotLight):
            return replace(light, direction=vector(r @ np.asarray(light.direction)))
        return light

    def per_length(sigma: d.Rgb) -> d.Rgb:
        return (sigma[0] / scale, sigma[1] / scale, sigma[2] / scale)

    def per_lengths(medium: d.Medium) -> d.Medium:
        sigma_a, sigma_s = (per_length(sigma) for sigma in medium.constant_sigmas())
        return d.Medium(sigma_a, sigma_s, medium.g)

    camera, medium = scene.camera, scene.medium
    return replace(
        scene,
        camera=replace(
            camera,
            to_world=rigid(camera.to_world),
            lens_radius=camera.lens_radius * scale,
            focus_distance=camera.focus_distance * scale,
            clip_start=camera.clip_start * scale,
            clip_end=camera.clip_end * scale,
        ),
        objects=tuple(moved(item) for item in scene.objects),
        spheres=tuple(
            replace(s, centers=np.array([place(c) for c in s.centers]), radii=np.asarray(s.radii) * scale)
            for s in scene.spheres
        ),
        lights=tuple(lamp(light) for light in scene.lights),
        environment=replace(scene.environment, to_world=rigid(scene.environment.to_world)),
        medium=None if medium is None else per_lengths(medium),
    )
