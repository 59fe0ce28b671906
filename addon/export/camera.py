# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's camera object -> Camera."""

from __future__ import annotations

from math import atan, degrees, hypot
from typing import TYPE_CHECKING

import numpy as np

from ..scene.description import WHOLE, Aperture, Camera, Floats, Orthographic, Panorama, Perspective, Projection
from ..scene.problems import GlimmerError, Notices, place
from .panorama import Window, panorama
from .stereo import Eye

if TYPE_CHECKING:
    import bpy


def side_in_widths(fit: str, size: tuple[float, float]) -> float:
    """The side of a picture of size (width, height) that Blender measures a camera by, AUTO: the longer one."""
    width, height = size
    return 1.0 if fit == "HORIZONTAL" or (fit == "AUTO" and width >= height) else height / width


def perspective(lens: float, sensor: tuple[float, float], fit: str, size: tuple[float, float]) -> Perspective:
    """Of a picture of size (width, height). AUTO has the sensor's width on the longer side."""
    fitted = sensor[1] if fit == "VERTICAL" else sensor[0]
    return Perspective(degrees(2.0 * atan(0.5 * fitted / lens / side_in_widths(fit, size))))


def orthographic(scale: float, fit: str, size: tuple[float, float]) -> Orthographic:
    """scale: what the measured side of the picture shows, a length."""
    return Orthographic(scale / side_in_widths(fit, size))


def unscaled(matrix: Floats) -> Floats:
    """As rigid, but what is mirrored stays so: so is the picture."""
    result = rigid(matrix)
    if float((result[:3, 1] * np.asarray(matrix)[:3, 1]).sum()) < 0.0:
        result[:3, 1] *= -1.0
    return result


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


def export_camera(
    camera_object: bpy.types.Object | None, size: tuple[float, float], notices: Notices, eye: Eye | None = None
) -> Camera:
    """size: (width, height) of the whole picture, in any unit. eye: of a view of a stereoscopic render."""
    if camera_object is None or camera_object.type != "CAMERA":
        raise GlimmerError("The scene has no camera: add one, or set it under Scene properties > Scene > Camera")
    data: bpy.types.Camera = camera_object.data
    where = place(camera_object.name)
    if data.type not in ("PERSP", "ORTHO", "PANO"):
        raise GlimmerError(_unsupported(camera_object))
    to_world: Floats = np.array(camera_object.matrix_world if eye is None else eye.to_world, np.float64)
    shift_x = data.shift_x if eye is None else eye.shift_x
    if not np.isfinite(to_world).all() or np.linalg.matrix_rank(to_world[:3, :3]) < 3:
        raise GlimmerError(f"Camera '{camera_object.name}' has a scale of 0 or a matrix that is not finite")
    to_world = unscaled(to_world)
    in_widths = side_in_widths(data.sensor_fit, size)
    lens_radius, focus_distance = _depth_of_field(data, to_world, where, notices)
    is_panoramic = data.type == "PANO"
    return Camera(
        to_world=to_world,
        projection=_panorama(camera_object, size, shift_x=shift_x) if is_panoramic else _projection(data, size),
        shift=(0.0, 0.0) if is_panoramic else (shift_x * in_widths, data.shift_y * in_widths),
        stereo=None if eye is None else eye.spherical,
        lens_radius=lens_radius,
        focus_distance=focus_distance,
        aperture=_aperture(data),
        clip_start=data.clip_start,
        clip_end=data.clip_end,
    )


def _projection(data: bpy.types.Camera, size: tuple[float, float]) -> Projection:
    if data.type == "ORTHO":
        return orthographic(data.ortho_scale, data.sensor_fit, size)
    return perspective(data.lens, (data.sensor_width, data.sensor_height), data.sensor_fit, size)


def _panorama(
    camera_object: bpy.types.Object, size: tuple[float, float], frame: Window = WHOLE, shift_x: float | None = None
) -> Panorama:
    """frame: what is shown of the picture, of size (width, height). The shift of a panorama is in parts of it."""
    data = camera_object.data
    sensor = data.sensor_height if data.sensor_fit == "VERTICAL" else data.sensor_width
    x, y = data.shift_x if shift_x is None else shift_x, -data.shift_y
    window = (frame[0] + x, frame[1] + y, frame[2] + x, frame[3] + y)
    return panorama(camera_object, sensor / side_in_widths(data.sensor_fit, size), window)


def window_around(frame: Window) -> Window:
    """What a region shows of a picture whose frame is at (min x, min y, max x, max y), in shares of the region from the
    bottom left: x0, y0, x1, y1 in shares of the picture from the top left."""
    x0, y0, x1, y1 = frame
    width, height = x1 - x0, y1 - y0
    return -x0 / width, (y1 - 1.0) / height, (1.0 - x0) / width, y1 / height


def view_projection(window_matrix: Floats) -> tuple[Projection, tuple[float, float]]:
    """The projection of a 3D view's region, and its shift in widths. window_matrix: (4, 4), as OpenGL's."""
    matrix = np.asarray(window_matrix, np.float64)
    across, up = float(matrix[0, 0]), float(matrix[1, 1])
    if matrix[3, 3] != 0.0:
        shift = (-0.5 * float(matrix[0, 3]), -0.5 * float(matrix[1, 3]) * across / up)
        return Orthographic(2.0 / across), shift
    shift = (0.5 * float(matrix[0, 2]), 0.5 * float(matrix[1, 2]) * across / up)
    return Perspective(degrees(2.0 * atan(1.0 / across))), shift


def export_view(
    view: bpy.types.SpaceView3D,
    region_view: bpy.types.RegionView3D,
    camera_object: bpy.types.Object | None,
    notices: Notices,
    frame: Window,
    size: tuple[float, float],
) -> Camera:
    """What a 3D view looks through. camera_object: evaluated, for a view through it, whose picture of size (width,
    height) is at `frame` (see window_around)."""
    data = None
    if region_view.view_perspective == "CAMERA" and camera_object is not None and camera_object.type == "CAMERA":
        data = camera_object.data
        if data.type not in ("PERSP", "ORTHO", "PANO"):
            raise GlimmerError(_unsupported(camera_object))
    projection: Projection
    projection, shift = view_projection(np.array(region_view.window_matrix))
    if data is not None and camera_object is not None and data.type == "PANO":
        projection, shift = _panorama(camera_object, size, window_around(frame)), (0.0, 0.0)
    to_world = unscaled(np.array(region_view.view_matrix.inverted(), np.float64))
    lens_radius, focus_distance = 0.0, 1.0
    if data is not None and camera_object is not None:
        lens_radius, focus_distance = _depth_of_field(data, to_world, place(camera_object.name), notices)
    clips = view if data is None else data
    clip_start, clip_end = clips.clip_start, clips.clip_end
    if data is None and isinstance(projection, Orthographic):  # such a view stands in the middle of what it shows
        clip_start, clip_end = -0.5 * clip_end, 0.5 * clip_end
    return Camera(
        to_world=to_world,
        projection=projection,
        shift=shift,
        lens_radius=lens_radius,
        focus_distance=focus_distance,
        aperture=Aperture() if data is None else _aperture(data),
        clip_start=clip_start,
        clip_end=clip_end,
    )


def _unsupported(camera_object: bpy.types.Object) -> str:
    kind = camera_object.data.type.lower()
    return f"Camera '{camera_object.name}' is {kind}; allowed: perspective, orthographic, panoramic"


def _depth_of_field(data: bpy.types.Camera, to_world: Floats, where: str, notices: Notices) -> tuple[float, float]:
    """Lens radius, and the distance in focus along the axis."""
    dof = data.dof
    if not dof.use_dof or dof.aperture_fstop <= 0.0:
        return 0.0, 1.0
    distance = dof.focus_distance
    if dof.focus_object is not None:
        target = np.array(dof.focus_object.matrix_world.translation, np.float64)
        distance = abs(float(((target - to_world[:3, 3]) * to_world[:3, 2]).sum()))
    # A lens is in millimetres whatever the scene's unit, and the f-number divides its diameter. An orthographic camera
    # has none; Cycles takes one unit for it.
    diameter = 1.0 if data.type == "ORTHO" else 1e-3 * data.lens
    radius, distance = 0.5 * diameter / dof.aperture_fstop, max(distance, 1e-5)
    reach = max(1.0, 1.0 / dof.aperture_ratio)
    if data.type == "PANO" and radius * reach > distance:
        notices.add(where, "the aperture is larger than the distance in focus; it is as large as that")
        radius = distance / reach
    return radius, distance


def _aperture(data: bpy.types.Camera) -> Aperture:
    dof = data.dof
    if not dof.use_dof:
        return Aperture()
    return Aperture(dof.aperture_blades, degrees(dof.aperture_rotation), dof.aperture_ratio)
