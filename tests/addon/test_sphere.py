# SPDX-License-Identifier: GPL-3.0-or-later
"""Which meshes pass for analytic spheres, and which do not."""

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from addon.export.sphere import FittedSphere, NotASphereError, fit_sphere

Points = NDArray[np.float64]
GOLDEN = (1 + 5**0.5) / 2


def directions(count: int) -> Points:
    points = np.random.default_rng(5).normal(size=(count, 3))
    return points / np.linalg.norm(points, axis=1, keepdims=True)


def hull(points: Points) -> tuple[Points, NDArray[np.intp]]:
    """A closed convex mesh of these vertices, its triangles counterclockwise from outside."""
    triangles = ConvexHull(points).simplices
    a, b, c = (points[triangles[:, corner]] for corner in range(3))
    inward = (np.cross(b - a, c - a) * (a - points.mean(axis=0))).sum(axis=1) < 0.0
    triangles[inward] = triangles[inward][:, ::-1]
    return points, triangles


def icosahedron() -> Points:
    corners = np.array([[0.0, s, t * GOLDEN] for s in (-1, 1) for t in (-1, 1)])
    return np.concatenate([np.roll(corners, shift, axis=1) for shift in range(3)])


@pytest.mark.parametrize("points", [directions(300), icosahedron()], ids=["fine", "icosahedron"])
@pytest.mark.parametrize("is_inside_out", [False, True])
def test_a_sphere_is_found_wherever_its_origin_is(points: Points, is_inside_out: bool) -> None:
    vertices, triangles = hull(points)
    sphere = fit_sphere(np.array([3.0, -2.0, 100.0]) + 0.25 * vertices, triangles[:, :: -1 if is_inside_out else 1])
    np.testing.assert_allclose(sphere.center, [3.0, -2.0, 100.0], atol=1e-9)
    assert sphere.radius == pytest.approx(0.25 * np.linalg.norm(points[0]), rel=1e-9)


SQUARE = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]])
CUBE = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
FINE, FACES = hull(directions(300))
DOME = FACES[FINE[FACES].mean(axis=1)[:, 2] > -0.5]


@pytest.mark.parametrize(
    ("vertices", "triangles", "why"),
    [
        (FINE * [1.0, 1.0, 1.5], FACES, "its vertices do not lie within 1% of one"),
        (SQUARE, np.array([[0, 1, 2], [1, 3, 2]]), "its vertices do not lie"),
        (np.zeros((4, 3)), np.array([[0, 1, 2]]), "its vertices do not lie"),
        (*hull(CUBE), "its faces are too coarse"),
        (FINE, DOME, "leave some of it open or cover it twice"),
        (FINE, np.concatenate([FACES, FACES]), "leave some of it open or cover it twice"),
        (FINE, FACES[:0], "leave some of it open"),
    ],
    ids=["ellipsoid", "plane", "one point", "cube", "dome", "double", "no faces"],
)
def test_what_is_no_sphere_is_told(vertices: Points, triangles: NDArray[np.intp], why: str) -> None:
    with pytest.raises(NotASphereError, match=why):
        fit_sphere(vertices, triangles)


def test_uneven_scale_is_told() -> None:
    sphere = FittedSphere(np.array([1.0, 0.0, 0.0]), 2.0)
    even, uneven = np.diag([3.0, 3.0, 3.0, 1.0]), np.diag([3.0, 3.0, 3.1, 1.0])
    even[:3, 3] = 5.0
    centers, radii = sphere.placed(even[np.newaxis])
    np.testing.assert_allclose(centers, [[8.0, 5.0, 5.0]])
    np.testing.assert_allclose(radii, [6.0])
    with pytest.raises(NotASphereError, match="scaled unevenly"):
        sphere.placed(np.stack([even, uneven]))
