# SPDX-License-Identifier: GPL-3.0-or-later

import numpy as np
import pytest
from numpy.typing import NDArray

from addon.export.mesh import fit_sphere, smooth_normals, split_by_normal
from addon.scene.problems import GlimmerError


def test_vertices_are_split_only_where_normals_differ() -> None:
    # Two triangles that share an edge (vertices 1 and 2), smooth across vertex 1 and creased at vertex 2.
    corner_vertices = np.array([0, 1, 2, 2, 1, 3])
    up, side = [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]
    normals = np.array([up, up, up, side, up, side], np.float32)
    source, new_vertex = split_by_normal(corner_vertices, normals)
    assert len(source) == 5
    assert new_vertex[1] == new_vertex[4]
    assert new_vertex[2] != new_vertex[3]
    np.testing.assert_array_equal(corner_vertices[source][new_vertex], corner_vertices)
    np.testing.assert_array_equal(normals[source][new_vertex], normals)


def test_normals_within_blenders_precision_are_one() -> None:
    normals = np.array([[0.0, 0.0, 1.0], [1e-6, 0.0, 1.0]], np.float32)
    source, _ = split_by_normal(np.array([7, 7]), normals)
    assert len(source) == 1


def directions(count: int) -> NDArray[np.float64]:
    points = np.random.default_rng(5).normal(size=(count, 3))
    return points / np.linalg.norm(points, axis=1, keepdims=True)


def test_a_sphere_is_found_wherever_its_origin_is() -> None:
    center, radius = fit_sphere(np.array([3.0, -2.0, 100.0]) + 0.25 * directions(40), "Moon")
    np.testing.assert_allclose(center, [3.0, -2.0, 100.0], atol=1e-9)
    assert radius == pytest.approx(0.25, rel=1e-9)


def test_half_a_sphere_is_one_too() -> None:
    points = directions(60)
    points[:, 2] = np.abs(points[:, 2])
    center, radius = fit_sphere(points, "Dome")
    np.testing.assert_allclose(center, 0.0, atol=1e-9)
    assert radius == pytest.approx(1.0)


@pytest.mark.parametrize(
    "points",
    [
        directions(50) * [1.0, 1.0, 1.5],
        np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]]),
        np.zeros((4, 3)),
    ],
    ids=["ellipsoid", "plane", "one point"],
)
def test_what_is_no_sphere_is_named(points: NDArray[np.float64]) -> None:
    with pytest.raises(GlimmerError, match="'Egg' is marked as an analytic sphere, but its mesh is none"):
        fit_sphere(points, "Egg")


def test_smooth_normals_are_weighed_by_the_angle() -> None:
    """The corner of a cube whose one side is cut into two triangles: its normal is the diagonal all the same."""
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 0], [1, 0, 1], [0, 1, 1]], np.float32)
    corner_vertices = np.array([0, 2, 4, 0, 4, 1, 0, 1, 5, 3, 0, 3, 6, 2])
    starts, totals = np.array([0, 3, 6, 10]), np.array([3, 3, 4, 4])
    faces = np.array([[0, 0, -1], [0, 0, -1], [0, -1, 0], [-1, 0, 0]], np.float32)
    normals = smooth_normals(vertices, corner_vertices, starts, totals, faces)
    np.testing.assert_allclose(normals[0], np.full(3, -(3**-0.5)), atol=1e-7)
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0, atol=1e-6)


def test_a_vertex_without_faces_has_no_normal() -> None:
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [9, 9, 9]], np.float32)
    up = np.array([[0, 0, 1]], np.float32)
    normals = smooth_normals(vertices, np.array([0, 1, 2]), np.array([0]), np.array([3]), up)
    np.testing.assert_array_equal(normals, [[0, 0, 1], [0, 0, 1], [0, 0, 1], [0, 0, 0]])
