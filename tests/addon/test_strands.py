# SPDX-License-Identifier: GPL-3.0-or-later
"""Strands as tubes: on the curve, as wide as they should be, and within their bound."""

from types import SimpleNamespace

import numpy as np
import pytest

from addon.export import strands
from addon.export.strands import Strands, profile, subdivided, tubes
from addon.scene.description import Mesh


def straight(count: int, keys: int, radius: float = 0.1) -> Strands:
    """Upright strands of length 1 side by side."""
    along = np.linspace(0.0, 1.0, keys)
    points = np.zeros((count, keys, 3))
    points[..., 0], points[..., 2] = np.arange(count)[:, None], along
    return Strands(points.reshape(-1, 3), np.full(count * keys, radius), np.full(count, keys))


def area(mesh: Mesh) -> float:
    a, b, c = (mesh.vertices[mesh.triangles[:, corner]].astype(np.float64) for corner in range(3))
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2.0)


def test_a_tubes_mean_silhouette_is_that_of_the_round_one() -> None:
    # By Cauchy it is a quarter of the area, also of what is open at the ends, seen from the side.
    found = tubes("Hair", straight(3, 4))
    assert found.kept == 1.0
    assert area(found.mesh) == pytest.approx(3 * 2.0 * np.pi * 0.1, rel=1e-5)


def test_faces_and_normals_point_outwards() -> None:
    mesh = tubes("Hair", straight(2, 3)).mesh
    assert mesh.normals is not None
    a, b, c = (mesh.vertices[mesh.triangles[:, corner]] for corner in range(3))
    faces = np.cross(b - a, c - a)
    assert ((faces * mesh.normals[mesh.triangles[:, 0]]).sum(axis=1) > 0.0).all()
    np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1.0, atol=1e-6)


def test_segments_follow_a_smooth_curve_within_each_strand() -> None:
    angles = np.linspace(0.0, np.pi, 9)
    arc = np.stack([np.cos(angles), np.sin(angles), np.zeros(9)], axis=1)
    two = Strands(np.concatenate([arc, arc + 5.0]), np.ones(18), np.array([9, 9]))
    fine = subdivided(two, 4)
    assert list(fine.counts) == [33, 33]
    np.testing.assert_allclose(fine.points[:33][::4], arc, atol=1e-12)
    np.testing.assert_allclose(fine.points[33:], fine.points[:33] + 5.0, atol=1e-12)
    inner = np.linalg.norm(fine.points[4:29], axis=1)
    np.testing.assert_allclose(inner, 1.0, atol=1e-3)
    assert np.abs(np.linalg.norm(0.5 * (arc[1:] + arc[:-1]), axis=1) - 1.0).max() > 1e-2  # of the chords


def test_a_strand_that_turns_at_right_angles_keeps_its_width() -> None:
    corners = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 1.0, 1.0], [0.0, 1.0, 1.0]])
    mesh = tubes("Hair", Strands(corners, np.full(5, 0.01), np.array([5]))).mesh
    assert np.isfinite(mesh.vertices).all()
    assert np.isfinite(mesh.normals).all() if mesh.normals is not None else False
    rings = mesh.vertices.reshape(-1, 12, 3)
    widths = np.linalg.norm(rings - rings.mean(axis=1, keepdims=True), axis=2)
    np.testing.assert_allclose(widths, widths[0, 0], rtol=1e-4)


@pytest.mark.parametrize("most", [100_000, 5_000, 2_000, 400])
def test_no_more_triangles_than_the_bound(most: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(strands, "MOST_TRIANGLES", most)
    many = straight(100, 9, radius=0.01)
    found = tubes("Hair", many)
    assert len(found.mesh.triangles) <= most
    assert (found.kept < 1.0) == (most < 100 * 2 * 6)
    assert (found.mesh.normals is None) == (most < 100 * 8 * 12)
    # What is left shows as much as all would.
    assert area(found.mesh) == pytest.approx(100 * 2.0 * np.pi * 0.01, rel=0.02)


def test_coarser_strands_are_told(monkeypatch: pytest.MonkeyPatch) -> None:
    many = straight(100, 9)
    assert tubes("Hair", many).each == 1
    monkeypatch.setattr(strands, "MOST_TRIANGLES", 3_000)
    assert tubes("Hair", many).each == 2


def test_flat_sides_of_parallel_strands_are_lit_as_round_ones(monkeypatch: pytest.MonkeyPatch) -> None:
    many = straight(500, 2)
    monkeypatch.setattr(strands, "MOST_TRIANGLES", 500 * 2 * 3)
    mesh = tubes("Hair", many).mesh
    a, b, c = (mesh.vertices[mesh.triangles[:, corner]].astype(np.float64) for corner in range(3))
    faces = np.cross(b - a, c - a) / 2.0
    areas = np.linalg.norm(faces, axis=1)
    for angle in np.linspace(0.0, 2.0 * np.pi, 24):
        # A lamp where the eye is: cosine by cosine over what is seen, which is a quarter of the round side's area.
        cosines = np.maximum(faces @ [np.cos(angle), np.sin(angle), 0.0] / areas, 0.0)
        assert (areas * cosines**2).sum() == pytest.approx(500 * 2.0 * np.pi * 0.1 / 4.0, rel=0.01)


def test_values_of_a_strand_are_those_of_its_faces() -> None:
    two = Strands(*(getattr(straight(2, 3), name) for name in ("points", "radii", "counts")))
    coloured = Strands(two.points, two.radii, two.counts, values=(("uv", np.array([[0.0, 0.5], [1.0, 0.25]])),))
    mesh = tubes("Hair", coloured).mesh
    (attribute,) = mesh.attributes
    assert (attribute.domain, len(attribute.values)) == ("face", len(mesh.triangles))
    of_second = mesh.vertices[mesh.triangles[:, 0]][:, 0] > 0.5
    np.testing.assert_array_equal(attribute.values[of_second], [[1.0, 0.25]] * int(of_second.sum()))
    np.testing.assert_array_equal(attribute.values[~of_second], [[0.0, 0.5]] * int((~of_second).sum()))


def test_radii_follow_the_strands_shape() -> None:
    settings = SimpleNamespace(shape=0.0, root_radius=2.0, tip_radius=1.0, radius_scale=0.1, use_close_tip=False)
    along = np.array([[0.0, 0.5, 1.0]])
    np.testing.assert_allclose(profile(along, settings), [[0.1, 0.075, 0.05]])
    settings.shape, settings.use_close_tip = 0.5, True
    np.testing.assert_allclose(profile(along, settings), [[0.1, 0.05 + 0.05 * 0.25, 0.0]])
    settings.shape = -0.5
    np.testing.assert_allclose(profile(along, settings), [[0.1, 0.05 + 0.05 * 0.5**0.5, 0.0]])
