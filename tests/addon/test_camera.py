# SPDX-License-Identifier: GPL-3.0-or-later
"""A camera's numbers against the geometry of a pinhole."""

from math import atan, degrees, radians, tan

import numpy as np
import pytest

from addon.export.camera import projection, rigid, view_projection
from addon.scene.problems import GlimmerError

SENSOR = (36.0, 24.0)


def view_plane(lens: float, fit: str, shift: tuple[float, float], size: tuple[int, int]) -> tuple[float, ...]:
    """left, right, bottom, top at distance 1, by Blender's own rule (BKE_camera_params_compute_viewplane)."""
    width, height = size
    sensor = SENSOR[1] if fit == "VERTICAL" else SENSOR[0]
    pixels = width if fit == "HORIZONTAL" or (fit == "AUTO" and width >= height) else height
    unit = sensor / lens / pixels
    x, y = shift[0] * pixels, shift[1] * pixels
    return (x - width / 2) * unit, (x + width / 2) * unit, (y - height / 2) * unit, (y + height / 2) * unit


@pytest.mark.parametrize("fit", ["AUTO", "HORIZONTAL", "VERTICAL"])
@pytest.mark.parametrize("size", [(480, 270), (270, 480), (100, 100)])
def test_projection_spans_blenders_view_plane(fit: str, size: tuple[int, int]) -> None:
    shift = (0.25, -0.4)
    fov_x, in_widths = projection(50.0, SENSOR, fit, shift, size)
    width = 2.0 * tan(radians(fov_x) / 2.0)
    height = width * size[1] / size[0]
    x, y = in_widths[0] * width, in_widths[1] * width
    plane = (x - width / 2, x + width / 2, y - height / 2, y + height / 2)
    np.testing.assert_allclose(plane, view_plane(50.0, fit, shift, size), rtol=1e-12)


def frustum(left: float, right: float, bottom: float, top: float, near: float, far: float) -> list[list[float]]:
    """OpenGL's, as Blender's regions have it."""
    return [
        [2 * near / (right - left), 0.0, (right + left) / (right - left), 0.0],
        [0.0, 2 * near / (top - bottom), (top + bottom) / (top - bottom), 0.0],
        [0.0, 0.0, -(far + near) / (far - near), -2 * far * near / (far - near)],
        [0.0, 0.0, -1.0, 0.0],
    ]


@pytest.mark.parametrize("shift", [(0.0, 0.0), (0.25, -0.4)])
@pytest.mark.parametrize("size", [(480, 270), (270, 480)])
def test_a_regions_matrix_spans_the_same_plane(size: tuple[int, int], shift: tuple[float, float]) -> None:
    near = 0.125
    left, right, bottom, top = (near * edge for edge in view_plane(50.0, "AUTO", shift, size))
    matrix = frustum(left, right, bottom, top, near, 100.0)
    fov_x, in_widths = view_projection(np.array(matrix), size)
    assert fov_x == pytest.approx(projection(50.0, SENSOR, "AUTO", shift, size)[0], rel=1e-12)
    np.testing.assert_allclose(in_widths, projection(50.0, SENSOR, "AUTO", shift, size)[1], atol=1e-12)


def test_an_orthographic_matrix_is_refused() -> None:
    with pytest.raises(GlimmerError, match="Orthographic"):
        view_projection(np.diag([0.1, 0.2, -0.01, 1.0]), (480, 270))


def test_landscape_of_a_full_frame_lens() -> None:
    fov_x, _ = projection(50.0, SENSOR, "AUTO", (0.0, 0.0), (1920, 1080))
    assert fov_x == pytest.approx(degrees(2.0 * atan(18.0 / 50.0)), rel=1e-15)


def test_rigid_drops_the_scale_and_keeps_the_rest() -> None:
    angle = 0.7
    turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
    matrix = np.eye(4)
    matrix[:3, :3] = turn * [2.0, 3.0, 0.5]
    matrix[:3, 3] = 1e6, 2.0, 3.0
    result = rigid(matrix)
    np.testing.assert_allclose(result[:3, :3], turn, atol=1e-14)
    np.testing.assert_array_equal(result[:3, 3], matrix[:3, 3])
