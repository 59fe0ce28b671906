# SPDX-License-Identifier: GPL-3.0-or-later
"""The ground that plates stand on, their patterns, breakage and look, in plain Python, against closed forms."""

import math
import sys
import time
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from addon.hexfield.ground import HeightImage, MeshGround
from addon.hexfield.layout import euler_to_matrix, lay_out
from addon.hexfield.look import look_of
from addon.hexfield.noise import Floats
from addon.hexfield.parameters import FieldParameters
from addon.hexfield.plate import Kind, PlateMesh, kinds, make_plate, prototype_count
from addon.hexfield.relief import relief
from addon.hexfield.scatter import scatter

STILL = dict.fromkeys(
    ("hill_height", "mutation_height", "mutation_tilt", "mutation_shape", "mutation_bevel", "roughness_spread"), 0.0
)


def still(**changes: object) -> FieldParameters:
    return FieldParameters(**{**STILL, **changes})  # type: ignore[arg-type]


LANDS = [
    {"hill_kind": "RIDGED"},
    {"hill_kind": "BILLOWED"},
    {"hill_kind": "DUNES", "wind": 0.7},
    {"crater_density": 0.7, "hill_height": 0.0},
    {"terrace_height": 0.7},
    {"path_width": 4.0},
    {"hill_kind": "DUNES", "crater_density": 0.7, "terrace_height": 0.7, "path_width": 4.0},
]


@pytest.mark.parametrize("changes", LANDS)
def test_slopes_are_the_derivatives_of_the_relief(changes: dict[str, object]) -> None:
    """Central differences: rounding 1e-16/step, truncation step^2 times the third derivative. Creases, where heights
    have no slope, are a null set; all functions are continuous."""
    parameters = FieldParameters(**changes)  # type: ignore[arg-type]
    x, y = np.random.default_rng(0).uniform(-100, 100, (2, 3000))
    z, slope_x, slope_y = relief(x, y, parameters)
    step = 1e-5

    def height(dx: float, dy: float) -> Floats:
        return relief(x + dx, y + dy, parameters)[0]

    for slope, found in (
        (slope_x, (height(step, 0) - height(-step, 0)) / (2 * step)),
        (slope_y, (height(0, step) - height(0, -step)) / (2 * step)),
    ):
        assert np.quantile(np.abs(found - slope), 0.99) < 1e-7
        assert np.abs(found * step).max() < 1e-3, "a cliff"
    assert z.std() > 0.05


@pytest.mark.parametrize("kind", ["SMOOTH", "RIDGED", "BILLOWED", "DUNES"])
def test_hills_stay_within_their_height(kind: str) -> None:
    x, y = np.random.default_rng(1).uniform(-500, 500, (2, 100_000))
    z = relief(x, y, FieldParameters(hill_kind=kind, hill_height=3.0))[0]
    assert np.abs(z).max() <= 3.0 and np.ptp(z) > 3.0


def test_dunes_are_steep_behind_the_wind() -> None:
    parameters = FieldParameters(hill_kind="DUNES", wind=0.0, hill_octaves=1)
    x, y = np.random.default_rng(2).uniform(-500, 500, (2, 100_000))
    _, _, along = relief(x, y, parameters)
    assert np.quantile(-along, 0.99) > 1.5 * np.quantile(along, 0.99)
    turned = FieldParameters(hill_kind="DUNES", wind=math.pi, hill_octaves=1)
    _, _, back = relief(x, y, turned)
    assert np.quantile(back, 0.99) > 1.5 * np.quantile(-back, 0.99)


def test_terraces_are_level_and_the_path_too() -> None:
    x, y = np.random.default_rng(3).uniform(-100, 100, (2, 50_000))
    z = relief(x, y, FieldParameters(terrace_height=0.5, terrace_flatness=1.0))[0] / 0.5
    assert np.mean(np.abs(z - np.round(z)) < 0.02) > 0.7
    parameters = FieldParameters(path_width=6.0, path_depth=0.7)
    on_path = 8.0 * np.sin(2 * np.pi * y / 60.0)
    z, slope_x, slope_y = relief(on_path, y, parameters)
    assert np.abs(z + 0.7).max() < 1e-12 and not slope_x.any() and not slope_y.any()


def test_on_a_planet_plates_are_where_the_sphere_is() -> None:
    """Distances along the ground from the middle stay, tops look away from the centre, and an eye at a height sees as
    far as the tangent reaches."""
    radius = 200.0
    layout = lay_out(still(rings=50, planet_radius=radius))
    flat = lay_out(still(rings=50))
    centre = np.array([0.0, 0.0, -radius])
    out = layout.positions - centre
    np.testing.assert_allclose(np.linalg.norm(out, axis=1), radius, rtol=1e-13)
    normal = euler_to_matrix(layout.rotations)[:, :, 2]
    np.testing.assert_allclose(normal, out / radius, atol=1e-12)
    angle = np.arctan2(np.hypot(out[:, 0], out[:, 1]), out[:, 2])
    np.testing.assert_allclose(radius * angle, np.hypot(*flat.positions[:, :2].T), atol=1e-9)
    assert layout.scales.min() == pytest.approx(math.sin(angle.max()) / angle.max(), rel=1e-9)
    eye = np.array([0.0, 0.0, 5.0])
    seen = np.einsum("ij,ij->i", normal, eye - layout.positions) > 0
    horizon = radius * math.acos(radius / (radius + 5.0))
    assert abs(radius * angle[seen].max() - horizon) < 2.0
    hilly, bare = (lay_out(FieldParameters(rings=9, planet_radius=r, mutation_turn=0.3)) for r in (1e9, 0.0))
    np.testing.assert_allclose(hilly.positions, bare.positions, atol=1e-6)
    np.testing.assert_allclose(hilly.rotations, bare.rotations, atol=1e-6)
    with pytest.raises(ValueError, match="planet_radius is 10; allowed for a field that reaches"):
        lay_out(still(rings=50, planet_radius=10.0))


def test_circles_run_around_the_clearing() -> None:
    layout = lay_out(still(pattern="CIRCLES", clearing=6.0, rings=5, gap=0.1))
    far = np.hypot(*layout.positions[:, :2].T)
    step = math.sqrt(3) + 0.1
    np.testing.assert_allclose(far, 7.0 + layout.rings * step, rtol=1e-12)
    assert np.array_equal(np.bincount(layout.rings), [int(2 * math.pi * (7 + k * step) / step) for k in range(6)])
    # The corner of a plate, its x axis, points outwards.
    out = euler_to_matrix(layout.rotations)[:, :, 0]
    np.testing.assert_allclose(out[:, :2], layout.positions[:, :2] / far[:, None], atol=1e-12)


def test_a_sector_is_what_lies_within_its_angle() -> None:
    whole = lay_out(still(rings=20))
    part = lay_out(still(rings=20, sector=1.0, sector_direction=0.4))
    x, y = whole.positions[:, :2].T
    away = np.abs(np.angle(np.exp(1j * (np.arctan2(-x, y) - 0.4))))
    assert len(part) == np.count_nonzero(away <= 0.5)


def test_scattered_points_keep_their_distance_and_leave_no_gaps() -> None:
    triangles = np.array([[[0, 0, 0], [30, 0, 0], [0, 30, 10]], [[30, 0, 0], [30, 30, 10], [0, 30, 10]]], float)
    points, normals = scatter(triangles, 1.0, 3, 10**6)
    apart = np.linalg.norm(points[:, None] - points, axis=2)
    np.fill_diagonal(apart, np.inf)
    assert apart.min() >= 1.0
    plane = np.array([0.0, -1.0, 3.0]) / math.sqrt(10)
    np.testing.assert_allclose(points @ plane, 0.0, atol=1e-12)
    np.testing.assert_allclose(normals, np.broadcast_to(plane, normals.shape), atol=1e-12)
    anywhere = np.random.default_rng(0).uniform(1, 29, (2000, 2))
    anywhere = np.column_stack([anywhere, anywhere[:, 1] / 3])
    nearest = np.linalg.norm(anywhere[:, None] - points, axis=2).min(axis=1)
    assert np.mean(nearest < 1.0) > 0.97 and nearest.max() < 2.0
    again, _ = scatter(triangles, 1.0, 3, 10**6)
    assert np.array_equal(points, again) and not np.array_equal(points[:50], scatter(triangles, 1.0, 4, 10**6)[0][:50])
    with pytest.raises(ValueError, match="allowed: up to 100"):
        scatter(triangles, 1.0, 3, 100)


def test_images_and_meshes_are_stood_on() -> None:
    rng = np.random.default_rng(0)
    x, y = rng.uniform(-9, 9, (2, 5000))
    rise = 0.2 * (np.arange(20)[:, None] + 0.5) + 0.1 * (np.arange(20) + 0.5)
    _, (z, slope_x, slope_y) = HeightImage(rise, 20.0, 2.0).at(x, y)
    np.testing.assert_allclose(z, 2.0 * (0.2 * (y + 10) + 0.1 * (x + 10)), atol=1e-9)
    np.testing.assert_allclose(slope_x, 0.2, atol=1e-9)
    np.testing.assert_allclose(slope_y, 0.4, atol=1e-9)
    axis = np.linspace(-10, 10, 41)
    corners = np.stack(np.meshgrid(axis, axis, indexing="ij"), axis=2)
    height = 0.3 * corners[..., :1] - 0.1 * corners[..., 1:]
    grid = np.concatenate([corners, height], axis=2)
    a, b, c, d = grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]
    triangles = np.concatenate([np.stack(t, axis=2).reshape(-1, 3, 3) for t in ((a, b, c), (a, c, d))])
    below = triangles - [0.0, 0.0, 5.0]  # a second floor, which nothing stands on
    wide = np.concatenate([x, [11.0]]), np.concatenate([y, [0.0]])
    found, (z, slope_x, slope_y) = MeshGround(np.concatenate([triangles, below])).at(*wide)
    assert found[:-1].all() and not found[-1]
    np.testing.assert_allclose(z[:-1], 0.3 * x - 0.1 * y, atol=1e-9)
    np.testing.assert_allclose(slope_x[:-1], 0.3, atol=1e-9)
    np.testing.assert_allclose(slope_y[:-1], -0.1, atol=1e-9)


def test_shares_of_plates_break() -> None:
    whole = lay_out(still(rings=60))
    broken = lay_out(still(rings=60, missing=0.2, sunken=0.3, sunken_depth=2.0, cracked=0.4))
    count = len(whole)
    for found, share, of in (
        (count - len(broken), 0.2, count),
        (np.count_nonzero(broken.positions[:, 2] < 0), 0.3, len(broken)),
        (np.count_nonzero(broken.prototypes >= 8), 0.4, len(broken)),
    ):
        assert abs(found - share * of) < 4.5 * math.sqrt(share * (1 - share) * of)
    assert broken.positions[:, 2].min() >= -2.0
    assert set(broken.prototypes.tolist()) == set(range(16))


def pieces_of(mesh: PlateMesh) -> int:
    """By Euler's formula: V - E + F is 2 for each closed piece without a hole."""
    faces = np.split(mesh.face_vertices, mesh.face_starts[1:])
    edges = [(a, b) for f in faces for a, b in zip(f.tolist(), np.roll(f, -1).tolist(), strict=True)]
    assert len(set(edges)) == len(edges) and {(b, a) for a, b in edges} == set(edges), "not closed"
    return (len(mesh.vertices) - len(edges) // 2 + len(faces)) // 2


def volume(mesh: PlateMesh) -> float:
    total = 0.0
    for face in np.split(mesh.face_vertices, mesh.face_starts[1:]):
        p = mesh.vertices[face]
        total += sum(float(p[0] @ np.cross(p[k], p[k + 1])) / 6 for k in range(1, len(p) - 1))
    return total


@pytest.mark.parametrize("changes", [{}, {"mutation_shape": 0.3}, {"bevel_width": 0.0}, {"bevel_width": 0.5}])
def test_cracked_plates_are_two_or_three_closed_pieces(changes: dict[str, object]) -> None:
    parameters = still(cracked=0.5, simplify=True, prototypes=12, crack_width=0.1, **changes)
    assert kinds(parameters) == [Kind.WHOLE, Kind.CRACKED, Kind.SIMPLE] and prototype_count(parameters) == 36
    counts = []
    for variant in range(12):
        whole, cracked, simple = (make_plate(parameters, variant + 12 * k) for k in range(3))
        counts.append(pieces_of(cracked))
        assert pieces_of(whole) == pieces_of(simple) == 1
        assert 0.3 * volume(whole) < volume(cracked)
        assert volume(cracked) < volume(whole) or counts[-1] == 1  # a bevel that wide leaves no room for pieces
        assert np.abs(cracked.vertices[:, :2]).max() <= np.abs(whole.vertices[:, :2]).max() + 1e-9
        assert len(simple.face_sizes) <= len(whole.face_sizes)
    assert set(counts) <= {1, 2, 3} and max(counts) >= (1 if changes == {"bevel_width": 0.5} else 2)
    if not changes:
        assert set(counts) == {2, 3}


def test_metals_come_by_weight_and_patina_where_it_is_asked_for() -> None:
    parameters = FieldParameters(
        rings=60,
        roughness_spread=0.0,
        second_weight=0.5,
        third_weight=0.5,
        metal_color=(0.5, 0.0, 0.0),
        second_color=(0.0, 0.5, 0.0),
        third_color=(0.0, 0.0, 0.5),
    )
    layout = lay_out(parameters)
    colors = look_of(layout, parameters).colors
    for channel, share in ((0, 0.5), (1, 0.25), (2, 0.25)):
        found = np.count_nonzero(colors[:, channel])
        assert abs(found - share * len(layout)) < 4.5 * math.sqrt(share * (1 - share) * len(layout))
    plain = {"rings": 60, "roughness_spread": 0.0, "patina_noise": 0.0}
    for amount, height in ((0.5, -1.0), (0.5, 1.0)):
        own = FieldParameters(patina=amount, patina_height=height, **plain)  # type: ignore[arg-type]
        look = look_of(layout, own)
        assert np.sign(np.corrcoef(look.patinas, layout.heights)[0, 1]) == np.sign(height)
        expected = own.metal_roughness + look.patinas * (own.patina_roughness - own.metal_roughness)
        np.testing.assert_allclose(look.roughnesses, expected, atol=1e-12)
    amounts = [look_of(layout, FieldParameters(patina=a, **plain)).patinas.mean() for a in (0.0, 0.3, 0.6, 1.0)]  # type: ignore[arg-type]
    assert amounts[0] == 0.0 and amounts == sorted(amounts) and amounts[-1] > 0.5


def test_colors_that_are_none_are_refused() -> None:
    with pytest.raises(ValueError, match=r"metal_color is .* allowed: three numbers from 0 up"):
        FieldParameters(metal_color=(0.5, -1.0, 0.0))


@pytest.mark.full
def test_two_million_plates_in_two_seconds() -> None:
    """Of the processor's time; the least of two, since the machine may be shared."""
    parameters = FieldParameters(rings=816, hill_follow=0.5, planet_radius=1e6)
    seconds = []
    for _ in range(2):
        start = time.process_time()
        layout = lay_out(parameters)
        look_of(layout, parameters)
        seconds.append(time.process_time() - start)
    assert len(layout) > 2_000_000
    assert min(seconds) < 3.0, seconds
