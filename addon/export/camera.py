# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's camera object -> Camera."""

from __future__ import annotations

from math import atan, degrees, hypot
from typing import TYPE_CHECKING

import numpy as np

from ..scene.description import Camera, Floats
from ..scene.problems import GlimmerError, Notices, place

if TYPE_CHECKING:
    import bpy


def projection(
    lens: float, sensor: tuple[float, float], fit: str, shift: tuple[float, float], size: tuple[int, int]
) -> tuple[float, tuple[float, float]]:
    """Horizontal angle in degrees, and the shift in widths, of a picture of size (width, height) with square pixels.

    Blender measures both on the side that the sensor is fitted to: AUTO is the longer one with the sensor's width.
    """
    width, height = size
    horizontal = fit == "HORIZONTAL" or (fit == "AUTO" and width >= height)
    fitted = sensor[1] if fit == "VERTICAL" else sensor[0]
    in_widths = 1.0 if horizontal else height / width
    return degrees(2.0 * atan(0.5 * fitted / lens / in_widths)), (shift[0] * in_widths, shift[1] * in_widths)


def rigid(matrix: Floats) -> Floats:
    """The rotation and translation of a matrix: looks along the same -z, with the same x axis to its right but for any
    shear. A camera's scale says nothing about what it sees.

    By hand, since LAPACK's last bits depend on where arrays lie in memory, and a picture must not.
    """
    x_axis, z_axis = ([float(v) for v in matrix[:3, column]] for column in (0, 2))
    z_axis = _normalized(z_axis)
    along = sum(a * b for a, b in zip(x_axis, z_axis, strict=True))
    x_axis = _normalized([a - along * b for a, b in zip(x_axis, z_axis, strict=True)])
    (zx, zy, zz), (xx, xy, xz) = z_axis, x_axis
    y_axis = [zy * xz - zz * xy, zz * xx - zx * xz, zx * xy - zy * xx]
    result = np.eye(4)
    result[:3, :3] = np.transpose([x_axis, y_axis, z_axis])
    result[:3, 3] = matrix[:3, 3]
    return result


def _normalized(vector: list[float]) -> list[float]:
    length = hypot(*vector)
    return [v / length for v in vector]


def export_camera(camera_object: bpy.types.Object | None, size: tuple[int, int], notices: Notices) -> Camera:
    """size: (width, height) of the whole picture in pixels."""
    if camera_object is None or camera_object.type != "CAMERA":
        raise GlimmerError("The scene has no camera: add one, or set it under Scene properties > Scene > Camera")
    data: bpy.types.Camera = camera_object.data
    where = place(camera_object.name)
    if data.type != "PERSP":
        raise GlimmerError(_unsupported(camera_object))
    to_world: Floats = np.array(camera_object.matrix_world, np.float64)
    if not np.isfinite(to_world).all() or np.linalg.matrix_rank(to_world[:3, :3]) < 3:
        raise GlimmerError(f"Camera '{camera_object.name}' has a scale of 0 or a matrix that is not finite")
    to_world = rigid(to_world)
    sensor = (data.sensor_width, data.sensor_height)
    fov_x, shift = projection(data.lens, sensor, data.sensor_fit, (data.shift_x, data.shift_y), size)
    lens_radius, focus_distance = _depth_of_field(data, to_world, where, notices)
    return Camera(
        to_world=to_world,
        fov_x=fov_x,
        shift=shift,
        lens_radius=lens_radius,
        focus_distance=focus_distance,
        clip_start=data.clip_start,
        clip_end=data.clip_end,
    )


def view_projection(window_matrix: Floats, size: tuple[int, int]) -> tuple[float, tuple[float, float]]:
    """Horizontal angle in degrees, and the shift in widths, of the projection of a region of size (width, height).

    window_matrix: (4, 4), as OpenGL's. Raises GlimmerError for an orthographic one.
    """
    matrix = np.asarray(window_matrix, np.float64)
    if matrix[3, 3] != 0.0:
        raise GlimmerError("Orthographic views are not supported yet: press Numpad 5 for perspective")
    across, up = float(matrix[0, 0]), float(matrix[1, 1])
    shift = (0.5 * float(matrix[0, 2]), 0.5 * float(matrix[1, 2]) * across / up)
    return degrees(2.0 * atan(1.0 / across)), shift


def export_view(
    view: bpy.types.SpaceView3D,
    region_view: bpy.types.RegionView3D,
    camera_object: bpy.types.Object | None,
    size: tuple[int, int],
    notices: Notices,
) -> Camera:
    """What a 3D view of size (width, height) looks through. camera_object: evaluated, for a view through it."""
    data = None
    if region_view.view_perspective == "CAMERA" and camera_object is not None and camera_object.type == "CAMERA":
        data = camera_object.data
        if data.type == "PANO":
            raise GlimmerError(_unsupported(camera_object))
    fov_x, shift = view_projection(np.array(region_view.window_matrix), size)
    to_world = rigid(np.array(region_view.view_matrix.inverted(), np.float64))
    lens_radius, focus_distance = 0.0, 1.0
    if data is not None and camera_object is not None:
        lens_radius, focus_distance = _depth_of_field(data, to_world, place(camera_object.name), notices)
    return Camera(
        to_world=to_world,
        fov_x=fov_x,
        shift=shift,
        lens_radius=lens_radius,
        focus_distance=focus_distance,
        clip_start=view.clip_start if data is None else data.clip_start,
        clip_end=view.clip_end if data is None else data.clip_end,
    )


def _unsupported(camera_object: bpy.types.Object) -> str:
    kind = camera_object.data.type
    word = {"ORTHO": "orthographic", "PANO": "panoramic"}.get(kind, kind.lower())
    return f"Camera '{camera_object.name}' is {word}, which is not supported yet; allowed: perspective"


def _depth_of_field(data: bpy.types.Camera, to_world: Floats, where: str, notices: Notices) -> tuple[float, float]:
    """Lens radius, and the distance in focus along the axis."""
    dof = data.dof
    if not dof.use_dof or dof.aperture_fstop <= 0.0:
        return 0.0, 1.0
    if dof.aperture_blades > 2 or dof.aperture_ratio != 1.0:
        notices.add(where, "aperture blades and ratio are not supported; the aperture is round")
    distance = dof.focus_distance
    if dof.focus_object is not None:
        target = np.array(dof.focus_object.matrix_world.translation, np.float64)
        distance = abs(float(((target - to_world[:3, 3]) * to_world[:3, 2]).sum()))
    # The lens is in millimetres whatever the scene's unit, and the f-number divides its diameter.
    return 0.5e-3 * data.lens / dof.aperture_fstop, max(distance, 1e-5)
