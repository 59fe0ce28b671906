# SPDX-License-Identifier: GPL-3.0-or-later

import numpy as np

from addon.export.affine import inverse
from addon.export.mesh import smooth_normals, split_by_normal


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


def test_the_inverse_of_a_place_is_exact_to_rounding() -> None:
    random = np.random.default_rng(3)
    for _ in range(20):
        matrix = np.eye(4)
        matrix[:3] = random.normal(size=(3, 4))
        np.testing.assert_allclose(inverse(matrix) @ matrix, np.eye(4), atol=1e-9)
    assert not inverse(np.diag([1.0, 0.0, 1.0, 1.0])).any()
