# SPDX-License-Identifier: GPL-3.0-or-later
"""What a field asks of its scene: the ground that it stands on, and the camera that looks at it."""

import dataclasses
import hashlib
from typing import Any

import bpy
import numpy as np

from .ground import Ground, HeightImage, MeshGround
from .noise import Floats

_WORDS = "hexagon field"


def ground_of(obj: Any, depsgraph: Any) -> tuple[Ground | None, str]:
    """What the plates of a field stand on in place of a plane, and a key that changes with it. Raises ValueError for a
    mesh without faces and an image without pixels."""
    group = obj.glimmer_field
    if group.ground is not None:
        mesh_ground = _mesh_ground(obj, group.ground, depsgraph or bpy.context.evaluated_depsgraph_get())
        return mesh_ground, f";ground={_fingerprint(mesh_ground.triangles)}"
    if group.height_image is not None:
        pixels = _red(group.height_image)
        image_ground = HeightImage(pixels, group.image_size, group.image_height)
        return image_ground, f";image={_fingerprint(pixels)}"
    return None, ""


def _fingerprint(values: Floats) -> str:
    return hashlib.blake2b(np.ascontiguousarray(values).tobytes(), digest_size=16).hexdigest()


def _mesh_ground(obj: Any, target: Any, depsgraph: Any) -> MeshGround:
    evaluated = target.evaluated_get(depsgraph)
    mesh = evaluated.to_mesh()
    try:
        mesh.calc_loop_triangles()
        vertices = np.empty(3 * len(mesh.vertices), np.float32)
        corners = np.empty(3 * len(mesh.loop_triangles), np.int32)
        mesh.vertices.foreach_get("co", vertices)
        mesh.loop_triangles.foreach_get("vertices", corners)
    finally:
        evaluated.to_mesh_clear()
    if len(corners) == 0:
        raise ValueError(f"{_WORDS}: ground is {target.name!r}, which has no faces")
    into = np.linalg.inv(np.array(obj.evaluated_get(depsgraph).matrix_world, np.float64))
    matrix = into @ np.array(evaluated.matrix_world, np.float64)
    points = vertices.reshape(-1, 3).astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
    return MeshGround(points[corners.reshape(-1, 3)])


def _red(image: Any) -> Floats:
    width, height = image.size
    if width == 0 or height == 0:
        raise ValueError(f"{_WORDS}: height_image is {image.name!r}, which has no pixels: is its file missing?")
    pixels = np.empty(width * height * image.channels, np.float32)
    image.pixels.foreach_get(pixels)
    return pixels.reshape(height, width, image.channels)[:, :, 0].astype(np.float64)


@dataclasses.dataclass(frozen=True)
class Viewer:
    """A camera in a field's own space."""

    place: tuple[float, float, float]
    scale: float  # pixels that a length of 1 covers at a distance of 1; at all distances without perspective
    is_perspective: bool

    def pixels(self, points: Floats, width: float) -> Floats:
        """How many a thing of that width covers at most, at each of the points, (n, 3)."""
        if not self.is_perspective:
            return np.full(len(points), self.scale * width)
        distance = np.sqrt(((points - np.array(self.place)) ** 2).sum(axis=1))
        return np.asarray(self.scale * width / np.maximum(distance, 1e-9))


def viewer_of(obj: Any, depsgraph: Any = None) -> Viewer | None:
    """The camera of the scene; None where it has none."""
    depsgraph = depsgraph or bpy.context.evaluated_depsgraph_get()
    scene = depsgraph.scene
    camera = scene.camera
    if camera is None or camera.type != "CAMERA":
        return None
    matrix = np.linalg.inv(np.array(obj.evaluated_get(depsgraph).matrix_world, np.float64))
    place = matrix @ np.append(np.array(camera.evaluated_get(depsgraph).matrix_world, np.float64)[:3, 3], 1.0)
    data, render = camera.evaluated_get(depsgraph).data, scene.render
    corners = data.view_frame(scene=scene)
    width = max(abs(corner.x) for corner in corners) * 2.0
    depth = abs(corners[0].z)
    is_perspective = data.type != "ORTHO"
    pixels = render.resolution_x * render.resolution_percentage / 100.0
    scale = pixels / width * (depth if is_perspective else 1.0)
    x, y, z = (float(round(value, 4)) for value in place[:3])
    return Viewer((x, y, z), float(scale), is_perspective)
