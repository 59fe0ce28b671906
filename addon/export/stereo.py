# SPDX-License-Identifier: GPL-3.0-or-later
"""The views of a stereoscopic render: pairs of eyes by the camera's own rules, or a camera for each view."""

from __future__ import annotations

from dataclasses import dataclass
from math import degrees, inf
from typing import TYPE_CHECKING

import numpy as np

from ..scene.description import Floats, SphericalStereo

if TYPE_CHECKING:
    import bpy


@dataclass(frozen=True)
class Eye:
    """How one view sees by a camera."""

    to_world: Floats
    shift_x: float  # as Blender's
    spherical: SphericalStereo | None = None


def active_views(render: bpy.types.RenderSettings) -> tuple[str, ...]:
    """Their names; one of no name without stereoscopy."""
    if not render.use_multiview:
        return ("",)
    is_pair = render.views_format == "STEREO_3D"
    return tuple(v.name for v in render.views if v.use and (not is_pair or v.name in ("left", "right"))) or ("",)


def eye_of(engine: bpy.types.RenderEngine, camera: bpy.types.Object, view: str) -> Eye:
    """Of the engine's active view, whose name is given. camera: evaluated."""
    is_spherical = engine.use_spherical_stereo(camera)
    matrix = np.array(engine.camera_model_matrix(camera, use_spherical_stereo=is_spherical), np.float64)
    shift = engine.camera_shift_x(camera, use_spherical_stereo=is_spherical)
    return Eye(matrix, shift, _spherical(camera.data.stereo, view) if is_spherical else None)


def _spherical(stereo: bpy.types.CameraStereoData, view: str) -> SphericalStereo | None:
    side = {"left": -0.5, "right": 0.5}.get(view)
    if side is None:
        return None
    meets = inf if stereo.convergence_mode == "PARALLEL" else stereo.convergence_distance
    merge = (degrees(stereo.pole_merge_angle_from), degrees(stereo.pole_merge_angle_to))
    return SphericalStereo(
        side * stereo.interocular_distance, meets, merge if stereo.use_pole_merge else (180.0, 180.0)
    )
