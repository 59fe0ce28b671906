# SPDX-License-Identifier: GPL-3.0-or-later
"""What a Blender camera sees of the moons."""

from math import atan2, pi
from typing import Any

from bpy_extras.object_utils import world_to_camera_view
from mathutils import Euler, Matrix, Vector

from .framing import Eye


def eye_of(scene: Any, camera: Any) -> Eye:
    """Of a perspective camera. One that looks straight up or down is taken to head where its upper edge points."""
    matrix = camera.matrix_world
    look, up = -matrix.col[2].to_3d(), matrix.col[1].to_3d()
    flat = look if look.to_2d().length > 1e-3 * look.length else (-up if look.z > 0.0 else up)
    right_edge, top_edge = (
        max(abs(corner[axis] / corner.z) for corner in camera.data.view_frame(scene=scene)) for axis in (0, 1)
    )
    return Eye(tuple(matrix.translation), atan2(-flat.x, flat.y), atan2(right_edge, 1.0), atan2(top_edge, 1.0))


def is_seen(scene: Any, camera: Any, location: tuple[float, float, float]) -> bool:
    x, y, z = world_to_camera_view(scene, camera, Vector(location))
    return 0.0 <= x <= 1.0 and 0.0 <= y <= 1.0 and z > 0.0


def upright(location: tuple[float, float, float], heading: float, pitch: float) -> Any:
    """The matrix of a camera there."""
    return Matrix.Translation(location) @ Euler((0.5 * pi + pitch, 0.0, heading)).to_matrix().to_4x4()
