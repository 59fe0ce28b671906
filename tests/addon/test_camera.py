# SPDX-License-Identifier: GPL-3.0-or-later
"""A camera's numbers against the rules of Blender's."""

from math import atan, degrees, radians, tan

import numpy as np
import pytest

from addon.export.camera import orthographic, perspective, rigid, side_in_widths, unscaled, view_projection
from addon.scene import description as d

SENSOR = (36.0, 24.0)


def view_plane(unit: float, fit: str, shift: tuple[float, float], size: tuple[int, int]) -> tuple[float, ...]:
    """left, right, bottom, top, by Blender's own rule (BKE_camera_params_compute_viewplane). unit: what the measured
    side shows.
    """
    width, height = size
    pixels = width if fit == "HORIZONTAL" or (fit == "AUTO" and width >= height) else height
    unit /= pixels
    x, y = shift[0] * pixels, shift[1] * pixels
    return (x - width / 2) * unit, (x + width / 2) * unit, (y - height / 2) * unit, (y + height / 2) * unit


def shown(width: float, shift: tuple[float, float], size: tuple[int, int]) -> tuple[float, ...]:
    """The same of an exported camera; shift in widths."""
    height = width * size[1] / size[0]
    x, y = shift[0] * width, shift[1] * width
    return (x - width / 2, x + width / 2, y - height / 2, y + height / 2)


SIZES = [(480, 270), (270, 480), (100, 100)]
SHIFT = (0.25, -0.4)


@pytest.mark.parametrize("fit", ["AUTO", "HORIZONTAL", "VERTICAL"])
@pytest.mark.parametrize("size", SIZES)
def test_projections_span_blenders_view_plane(fit: str, size: tuple[int, int]) -> None:
    in_widths = (SHIFT[0] * side_in_widths(fit, size), SHIFT[1] * side_in_widths(fit, size))
    width = 2.0 * tan(radians(perspective(50.0, SENSOR, fit, size).fov_x) / 2.0)
    expected = view_plane((SENSOR[1] if fit == "VERTICAL" else SENSOR[0]) / 50.0, fit, SHIFT, size)
    np.testing.assert_allclose(shown(width, in_widths, size), expected, rtol=1e-12)
    width = orthographic(7.0, fit, size).width
    np.testing.assert_allclose(shown(width, in_widths, size), view_plane(7.0, fit, SHIFT, size), rtol=1e-12)


def frustum(left: float, right: float, bottom: float, top: float, near: float, far: float) -> list[list[float]]:
    """OpenGL's, as Blender's regions have it."""
    return [
        [2 * near / (right - left), 0.0, (right + left) / (right - left), 0.0],
        [0.0, 2 * near / (top - bottom), (top + bottom) / (top - bottom), 0.0],
        [0.0, 0.0, -(far + near) / (far - near), -2 * far * near / (far - near)],
        [0.0, 0.0, -1.0, 0.0],
    ]


def box(left: float, right: float, bottom: float, top: float, near: float, far: float) -> list[list[float]]:
    """The same of an orthographic view."""
    return [
        [2 / (right - left), 0.0, 0.0, -(right + left) / (right - left)],
        [0.0, 2 / (top - bottom), 0.0, -(top + bottom) / (top - bottom)],
        [0.0, 0.0, -2 / (far - near), -(far + near) / (far - near)],
        [0.0, 0.0, 0.0, 1.0],
    ]


@pytest.mark.parametrize("shift", [(0.0, 0.0), SHIFT])
@pytest.mark.parametrize("size", SIZES)
def test_a_regions_matrix_spans_the_same_plane(size: tuple[int, int], shift: tuple[float, float]) -> None:
    near, plane = 0.125, view_plane(0.72, "AUTO", shift, size)
    left, right, bottom, top = (near * edge for edge in plane)
    seen, in_widths = view_projection(np.array(frustum(left, right, bottom, top, near, 100.0)))
    assert isinstance(seen, d.Perspective)
    np.testing.assert_allclose(shown(2.0 * tan(radians(seen.fov_x) / 2.0), in_widths, size), plane, atol=1e-12)
    left, right, bottom, top = plane
    seen, in_widths = view_projection(np.array(box(left, right, bottom, top, -50.0, 50.0)))
    assert isinstance(seen, d.Orthographic)
    np.testing.assert_allclose(shown(seen.width, in_widths, size), plane, atol=1e-12)


def test_landscape_of_a_full_frame_lens() -> None:
    fov_x = perspective(50.0, SENSOR, "AUTO", (1920, 1080)).fov_x
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


def test_what_is_mirrored_stays_so() -> None:
    mirrored = np.eye(4)
    mirrored[:3, :3] = np.diag([-2.0, 3.0, 0.5])
    np.testing.assert_allclose(unscaled(mirrored)[:3, :3], np.diag([-1.0, 1.0, 1.0]), atol=1e-15)
    np.testing.assert_allclose(unscaled(-mirrored)[:3, :3], np.diag([1.0, -1.0, -1.0]), atol=1e-15)
    assert np.linalg.det(rigid(mirrored)[:3, :3]) == pytest.approx(1.0)
