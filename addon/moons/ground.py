# SPDX-License-Identifier: GPL-3.0-or-later
"""The ground that a camera is to look over."""

from typing import Any

import numpy as np
from mathutils import Vector
from numpy.typing import NDArray


def field_points(view_layer: Any) -> NDArray[np.float64]:
    """The centres of the plates of all hexagon fields that are to be seen, in the world: shape (n, 3)."""
    parts = [np.empty((0, 3))]
    for obj in view_layer.objects:
        field = getattr(obj, "glimmer_field", None)
        if field is None or not field.enabled or obj.type != "MESH" or obj.hide_render or not obj.visible_get():
            continue
        points = np.empty(3 * len(obj.data.vertices), np.float32)
        obj.data.vertices.foreach_get("co", points)
        matrix = np.array(obj.matrix_world)
        parts.append(points.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3])
    return np.concatenate(parts)


def floor_below(context: Any, place: tuple[float, float, float]) -> float:
    """The height of the first surface straight below; of the 3D cursor, where objects are added, if there is none."""
    depsgraph = context.evaluated_depsgraph_get()
    hit, location, *_ = context.scene.ray_cast(depsgraph, Vector(place), Vector((0.0, 0.0, -1.0)))
    return float(location.z if hit else context.scene.cursor.location.z)
