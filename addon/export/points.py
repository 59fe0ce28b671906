# SPDX-License-Identifier: GPL-3.0-or-later
"""Point clouds: each point is a sphere."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..scene.description import Floats
from .mesh import read

if TYPE_CHECKING:
    import bpy

DEFAULT_RADIUS = 0.01  # of points without radii; Cycles' own


def point_cloud(cloud: bpy.types.PointCloud) -> tuple[Floats, Floats]:
    """Centres (n, 3) and radii (n,) in the space of the object."""
    centers = read(cloud.points, "co", np.float32, 3).astype(np.float64)
    radii: Floats = np.full(len(centers), DEFAULT_RADIUS)
    own = cloud.attributes.get("radius")
    if own is not None and own.domain == "POINT" and own.data_type == "FLOAT":
        radii = read(own.data, "value", np.float32).astype(np.float64)
    return centers, radii
