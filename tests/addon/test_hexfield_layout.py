# SPDX-License-Identifier: GPL-3.0-or-later
"""Layout and plates of hexagon fields, in plain Python, against closed forms and counted statistics."""

import itertools
import math
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import stats

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from addon.hexfield.layout import FieldLayout, euler_to_matrix, lay_out, spacing
from addon.hexfield.noise import Floats, hills, random_unit
from addon.hexfield.parameters import MOST_RINGS, FieldParameters, Part, controls
from addon.hexfield.plate import BEVEL_SLOT, PLATE_SLOT, PlateMesh, make_plate

# By chance, one run of all of them in a thousand would fail; seeds are fixed, so that it does not by itself.
STATISTICAL_TESTS = 60
LEVEL = 1e-3 / STATISTICAL_TESTS

FLAT = {
    "hill_height": 0.0,
    "mutation_height": 0.0,
    "mutation_tilt": 0.0,
    "mutation_turn": 0.0,
    "mutation_size": 0.0,
    "mutation_shape": 0.0,
    "mutation_bevel": 0.0,
}


def flat(**changes: object) -> FieldParameters:
    """A field without hills and mutations, but for `changes`."""
    return FieldParameters(**{**FLAT, **changes})  # type: ignore[arg-type]


def assert_uniform(values: Floats, low: float, high: float, bins: int = 50) -> None:
    assert values.min() >= low
    assert values.max() <= high
    counts = np.histogram(values, bins=bins, range=(low, high))[0]
    assert stats.chisquare(counts).pvalue > LEVEL


# ---- Layout


@pytest.mark.parametrize("rings", [0, 1, 2, 17])
def test_rings_hold_the_centred_hexagonal_number_of_plates(rings: int) -> None:
    assert len(lay_out(flat(rings=rings))) == 1 + 3 * rings * (rings + 1)


def test_inner_plates_have_six_neighbours_at_the_gap() -> None:
    parameters = flat(rings=4, plate_radius=0.7, gap=0.11)
    xy = lay_out(parameters).positions[:, :2]
    distance = np.hypot(*(xy[:, np.newaxis] - xy).T)
    np.fill_diagonal(distance, np.inf)
    step = math.sqrt(3) * 0.7 + 0.11
    assert spacing(parameters) == pytest.approx(step, rel=1e-15)
    assert distance.min() == pytest.approx(step, rel=1e-12)
    neighbours = np.isclose(distance, step, rtol=1e-9, atol=0).sum(axis=1)
    inner = 1 + 3 * 3 * 4
    assert np.count_nonzero(neighbours == 6) == inner
    # Corners of the outline have 3, the rest of its plates 4.
    assert np.count_nonzero(neighbours == 3) == 6
    assert np.count_nonzero(neighbours == 4) == 3 * 6


@pytest.mark.parametrize("radius", [0.0, 1.0, 7.3, 20.0])
def test_radius_takes_exactly_the_centres_within_it(radius: float) -> None:
    everything = lay_out(flat(rings=20)).positions
    expected = everything[np.hypot(everything[:, 0], everything[:, 1]) <= radius]
    found = lay_out(flat(extent="RADIUS", radius=radius)).positions
    assert {tuple(p) for p in found.round(9)} == {tuple(p) for p in expected.round(9)}


def test_clearing_leaves_out_exactly_the_plates_that_reach_into_it() -> None:
    everything = lay_out(flat(rings=9)).positions
    distance = np.hypot(everything[:, 0], everything[:, 1])
    found = lay_out(flat(rings=9, clearing=4.0)).positions
    assert np.array_equal(found, everything[distance - 1.0 >= 4.0])
    assert 0 < len(found) < len(everything)
    assert len(lay_out(flat(rings=2, clearing=100.0))) == 0


def test_layout_is_repeatable_and_depends_on_the_seed() -> None:
    parameters = FieldParameters(rings=9, mutation_turn=0.2, mutation_size=0.1)
    first, second = lay_out(parameters), lay_out(parameters)
    other = lay_out(FieldParameters(rings=9, mutation_turn=0.2, mutation_size=0.1, seed=1))
    for name in ("positions", "rotations", "scales", "prototypes"):
        assert np.array_equal(getattr(first, name), getattr(second, name))
        assert not np.array_equal(getattr(first, name), getattr(other, name))


def test_a_field_that_grows_keeps_its_plates() -> None:
    def by_place(layout: FieldLayout) -> dict[tuple[float, ...], tuple[float, ...]]:
        rest = np.column_stack([layout.positions[:, 2], layout.rotations, layout.scales, layout.prototypes])
        keys = layout.positions[:, :2].round(9)
        return {tuple(key): tuple(values) for key, values in zip(keys.tolist(), rest.tolist(), strict=True)}

    small = by_place(lay_out(FieldParameters(rings=6, mutation_turn=0.3, mutation_size=0.2)))
    large = by_place(lay_out(FieldParameters(rings=11, mutation_turn=0.3, mutation_size=0.2)))
    assert small.items() <= large.items()


def test_tops_follow_the_hills() -> None:
    parameters = flat(rings=40, hill_height=7.0, hill_wavelength=15.0, hill_octaves=4, seed=2)
    layout = lay_out(parameters)
    x, y, z = layout.positions.T
    assert np.array_equal(z, 7.0 * hills(x, y, 15.0, 4, 2)[0])
    assert np.abs(z).max() <= 7.0
    assert z.std() > 0.5, "no hills to speak of"
    assert not layout.rotations.any()


def test_plates_that_follow_the_slope_have_the_hills_normal() -> None:
    parameters = flat(rings=20, hill_height=5.0, hill_follow=1.0)
    layout = lay_out(parameters)
    x, y, _ = layout.positions.T
    _, slope_x, slope_y = hills(x, y, parameters.hill_wavelength, parameters.hill_octaves, parameters.seed)
    normal = np.column_stack([-5.0 * slope_x, -5.0 * slope_y, np.ones_like(x)])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    np.testing.assert_allclose(euler_to_matrix(layout.rotations)[:, :, 2], normal, rtol=0, atol=1e-12)


def test_mutations_fill_their_ranges_evenly() -> None:
    layout = lay_out(
        flat(rings=60, mutation_height=0.3, mutation_tilt=0.2, mutation_turn=0.4, mutation_size=0.25, prototypes=7)
    )
    assert_uniform(layout.positions[:, 2], -0.3, 0.3)
    assert_uniform(layout.scales[:, 0], 0.75, 1.0)
    assert np.array_equal(layout.scales[:, 0], layout.scales[:, 2])
    rotation = euler_to_matrix(layout.rotations)
    tilt = np.arccos(np.clip(rotation[:, 2, 2], -1, 1))
    assert_uniform(tilt, 0.0, 0.2 + 1e-9)
    leaning = tilt > 1e-3
    assert_uniform(np.arctan2(rotation[:, 1, 2], rotation[:, 0, 2])[leaning], -math.pi, math.pi)
    assert set(layout.prototypes.tolist()) == set(range(7))
    assert stats.chisquare(np.bincount(layout.prototypes)).pvalue > LEVEL
    turned = lay_out(flat(rings=60, mutation_turn=0.4))
    assert_uniform(turned.rotations[:, 2], -0.4, 0.4)


def test_mutations_have_nothing_to_do_with_each_other() -> None:
    layout = lay_out(
        flat(rings=60, mutation_height=1.0, mutation_tilt=0.2, mutation_turn=0.4, mutation_size=0.25, prototypes=5)
    )
    rotation = euler_to_matrix(layout.rotations)
    direction = np.arctan2(rotation[:, 1, 2], rotation[:, 0, 2])
    # What is left of the rotation without its lean is the turn.
    cosine = rotation[:, 2, 2]
    turn = np.arctan2(rotation[:, 1, 0] - rotation[:, 0, 1], rotation[:, 0, 0] + rotation[:, 1, 1])
    columns = [layout.positions[:, 2], cosine, direction, turn, layout.scales[:, 0], layout.prototypes]
    for one, other in itertools.combinations(columns, 2):
        # Ranks make every continuous column uniform.
        ranks = [stats.rankdata(column) / len(layout) for column in (one, other)]
        assert stats.spearmanr(*ranks).pvalue > LEVEL
        table = stats.contingency.crosstab(*(np.floor(rank * 4.999) for rank in ranks)).count
        assert stats.chi2_contingency(table).pvalue > LEVEL


def test_rotations_are_rotations() -> None:
    layout = lay_out(FieldParameters(rings=20, mutation_tilt=1.2, mutation_turn=3.0, hill_follow=1.0, hill_height=9.0))
    rotation = euler_to_matrix(layout.rotations)
    np.testing.assert_allclose(
        rotation @ np.swapaxes(rotation, 1, 2), np.broadcast_to(np.eye(3), rotation.shape), atol=1e-14
    )
    np.testing.assert_allclose(np.linalg.det(rotation), 1.0, rtol=1e-13)


def test_hundred_thousand_plates_in_well_under_a_second() -> None:
    parameters = FieldParameters(rings=183, hill_octaves=5, mutation_turn=0.1, mutation_size=0.1, hill_follow=0.5)
    seconds = []
    for _ in range(3):
        start = time.process_time()
        layout = lay_out(parameters)
        seconds.append(time.process_time() - start)
    assert len(layout) > 100_000
    assert min(seconds) < 1.0


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"gap": -1.0}, "hexagon field: gap is -1.0; allowed: 0 to inf"),
        ({"hill_octaves": 0}, "hexagon field: hill_octaves is 0; allowed: 1 to 12"),
        ({"thickness": math.nan}, "hexagon field: thickness is nan; allowed: 0.0001 to inf"),
        ({"thickness": math.inf}, "hexagon field: thickness is inf; allowed: 0.0001 to inf"),
        ({"extent": "DISC"}, "hexagon field: extent is 'DISC'; allowed: RINGS, RADIUS"),
        (
            {"extent": "RADIUS", "radius": 1e6},
            "hexagon field: radius is 1e+06; allowed with plates of this size: 0 to 1862.35",
        ),
    ],
)
def test_bad_parameters_are_named(changes: dict[str, object], message: str) -> None:
    with pytest.raises(ValueError) as caught:
        lay_out(flat(**changes))
    assert str(caught.value).startswith(message)


def test_the_most_rings_are_allowed_by_radius_too() -> None:
    limit = flat(rings=0)
    farthest = MOST_RINGS * spacing(limit) * math.sqrt(0.75)
    with pytest.raises(ValueError, match="radius is"):
        lay_out(flat(extent="RADIUS", radius=farthest * 1.01))


def test_keys_tell_what_has_to_be_made_anew() -> None:
    base = FieldParameters()
    for name, control in controls():
        value = getattr(base, name)
        if control.choices:
            other: object = next(choice[0] for choice in control.choices if choice[0] != value)
        elif isinstance(value, bool):
            other = not value
        elif isinstance(value, tuple):
            other = (0.1, *value[1:])
        else:
            other = type(value)(value + 1) if value + 1 <= control.maximum else control.maximum / 3
        changed = FieldParameters(**{name: other})  # type: ignore[arg-type]
        for part in (Part.LAYOUT, Part.PLATES, Part.LOOK, Part.DISPLAY):
            assert (changed.key(part) != base.key(part)) == bool(control.part & part), name


# ---- Noise


def test_random_numbers_are_uniform_and_independent_of_their_neighbours() -> None:
    i, j = (grid.ravel() for grid in np.meshgrid(np.arange(-200, 200), np.arange(-200, 200)))
    u = random_unit(i, j, seed=1, stream=0)
    assert_uniform(u, 0.0, 1.0, bins=200)
    pairs = [
        random_unit(i + 1, j, 1, 0),
        random_unit(i, j + 1, 1, 0),
        random_unit(j, i, 1, 0)[i != j],
        random_unit(i, j, 2, 0),
        random_unit(i, j, 1, 1),
    ]
    for other in pairs:
        mine = u if len(other) == len(u) else u[i != j]
        joint = np.histogram2d(mine, other, bins=10, range=((0, 1), (0, 1)))[0]
        assert stats.chisquare(joint.ravel()).pvalue > LEVEL


@pytest.mark.parametrize("octaves", [1, 4])
def test_slopes_are_the_derivatives_of_the_hills(octaves: int) -> None:
    rng = np.random.default_rng(0)
    x, y = rng.uniform(-50, 50, (2, 2000))
    _, slope_x, slope_y = hills(x, y, 13.0, octaves, 3)
    step = 1e-5

    def height(dx: float, dy: float) -> Floats:
        return hills(x + dx, y + dy, 13.0, octaves, 3)[0]

    # Central differences: rounding 1e-16/step, truncation step^2 times the third derivative, (2 pi 8/13)^3 or so.
    np.testing.assert_allclose((height(step, 0) - height(-step, 0)) / (2 * step), slope_x, rtol=0, atol=1e-8)
    np.testing.assert_allclose((height(0, step) - height(0, -step)) / (2 * step), slope_y, rtol=0, atol=1e-8)


def test_hills_scale_with_their_wavelength_and_stay_within_one() -> None:
    rng = np.random.default_rng(1)
    x, y = rng.uniform(-1000, 1000, (2, 200_000))
    for octaves in (1, 3, 8):
        height, _, _ = hills(x, y, 10.0, octaves, 0)
        assert np.abs(height).max() <= 1.0
        assert height.std() > 0.1
        np.testing.assert_allclose(hills(2 * x, 2 * y, 20.0, octaves, 0)[0], height, rtol=0, atol=1e-9)


# ---- Plates


def faces_of(mesh: PlateMesh) -> list[NDArray[np.int32]]:
    return np.split(mesh.face_vertices, mesh.face_starts[1:])


def area_vector(points: Floats) -> Floats:
    """Normal times area of a plane polygon."""
    return 0.5 * np.cross(points, np.roll(points, -1, axis=0)).sum(axis=0)


def volume(mesh: PlateMesh) -> float:
    """By the divergence theorem, with every face as a fan of triangles."""
    total = 0.0
    for face in faces_of(mesh):
        points = mesh.vertices[face]
        for second, third in itertools.pairwise(points[1:]):
            total += float(points[0] @ np.cross(second, third)) / 6
    return total


PLATES = [
    {},
    {"bevel_width": 0.0},
    {"bevel_segments": 1},
    {"bevel_segments": 1, "mutation_bevel": 0.5},
    {"mutation_shape": 0.3},
    {"mutation_bevel": 0.5, "bevel_segments": 4},
    {"mutation_shape": 0.3, "mutation_bevel": 0.5, "bevel_segments": 5, "bevel_width": 0.3},
    {"bevel_width": 5.0, "thickness": 0.2},
    {"plate_radius": 1e-3, "thickness": 5.0, "bevel_width": 0.1},
]


@pytest.mark.parametrize("changes", PLATES)
@pytest.mark.parametrize("prototype", [0, 5])
def test_plates_are_closed_and_face_outwards(changes: dict[str, object], prototype: int) -> None:
    mesh = make_plate(flat(**changes), prototype)
    faces = faces_of(mesh)
    assert mesh.face_sizes.min() >= 3
    edges = [(a, b) for face in faces for a, b in zip(face.tolist(), np.roll(face, -1).tolist(), strict=True)]
    assert len(set(edges)) == len(edges), "an edge is run through twice in the same direction"
    assert {(b, a) for a, b in edges} == set(edges), "the mesh is not closed"
    assert len(mesh.vertices) - len(edges) // 2 + len(faces) == 2, "not one sphere-like piece"
    assert np.array_equal(np.unique(mesh.face_vertices), np.arange(len(mesh.vertices)))
    assert volume(mesh) > 0
    # Star-shaped about a point inside: every face turns its outside away from it. Strong bumps overhang.
    if changes.get("mutation_bevel", 0.0) != 0.0:
        return
    inside = np.array([0, 0, -0.5 * flat(**changes).thickness])
    for face in faces:
        points = mesh.vertices[face] - inside
        assert area_vector(points) @ points[0] > 0
    assert not mesh.vertices[:, :2].any(axis=1).all(), "the middle of the top is a vertex"


@pytest.mark.parametrize("segments", [1, 3])
def test_a_plate_without_mutations_is_convex(segments: int) -> None:
    mesh = make_plate(flat(bevel_segments=segments, bevel_width=0.2), 0)
    for face in faces_of(mesh):
        points = mesh.vertices[face]
        normal = area_vector(points)
        normal /= np.linalg.norm(normal)
        distance = (mesh.vertices - points[0]) @ normal
        assert distance.max() < 1e-14
        assert np.abs(distance[face]).max() < 1e-14, "a face is not plane"


def test_without_bevel_it_is_the_hexagonal_prism() -> None:
    mesh = make_plate(flat(plate_radius=1.3, thickness=0.4, bevel_width=0.0), 0)
    assert volume(mesh) == pytest.approx(1.5 * math.sqrt(3) * 1.3**2 * 0.4, rel=1e-14)
    assert not (mesh.slots == BEVEL_SLOT).any()


def test_volume_converges_to_the_rounded_prism() -> None:
    """Half of Steiner's formula for a flat hexagon grown by w, and below it the straight part."""
    w, thickness, inner = 0.2, 0.7, 1.0 - 0.2 / math.sqrt(0.75)
    area, perimeter = 1.5 * math.sqrt(3) * inner**2, 6 * inner
    rounded = area * w + math.pi / 4 * perimeter * w**2 + 2 / 3 * math.pi * w**3
    exact = rounded + (thickness - w) * (area + perimeter * w + math.pi * w**2)

    def missing(segments: int) -> float:
        return exact - volume(make_plate(flat(thickness=thickness, bevel_width=w, bevel_segments=segments), 0))

    assert missing(8) > missing(16) > missing(32) > 0
    # The error of inscribed facets falls with the square of their number.
    assert missing(16) / missing(32) == pytest.approx(4, rel=0.02)


def test_slots_part_the_flat_from_the_rounded() -> None:
    w, thickness, inner = 0.1, 0.6, 1.0 - 0.1 / math.sqrt(0.75)
    mesh = make_plate(flat(thickness=thickness, bevel_width=w), 0)
    vectors = np.array([area_vector(mesh.vertices[face]) for face in faces_of(mesh)])
    sizes = np.linalg.norm(vectors, axis=1)
    plate = mesh.slots == PLATE_SLOT
    up = vectors[:, 2] / sizes
    assert sizes[plate & (up > 0.999)].sum() == pytest.approx(1.5 * math.sqrt(3) * inner**2, rel=1e-12)
    assert sizes[plate & (np.abs(up) < 1e-12)].sum() == pytest.approx(6 * inner * (thickness - w), rel=1e-12)
    assert np.count_nonzero(plate) == 6 + 6 + 1
    assert np.array_equal(mesh.smooth, ~plate)
    assert not make_plate(flat(bevel_smooth=False), 0).smooth.any()
    assert set(mesh.slots.tolist()) == {PLATE_SLOT, BEVEL_SLOT}


def test_mutants_differ_and_keep_within_the_plate() -> None:
    parameters = flat(mutation_shape=0.3, bevel_segments=4)
    meshes = [make_plate(parameters, prototype) for prototype in range(6)]
    for one, other in itertools.combinations(meshes, 2):
        assert not np.allclose(one.vertices, other.vertices)
    angles = np.radians(30 + 60 * np.arange(6))
    outward = np.column_stack([np.cos(angles), np.sin(angles)])
    for mesh in meshes:
        assert (mesh.vertices[:, :2] @ outward.T).max() <= math.sqrt(0.75) + 1e-12
        assert mesh.vertices[:, 2].max() <= 1e-15
        assert mesh.vertices[:, 2].min() == -parameters.thickness
        assert volume(mesh) > 0
    again = make_plate(parameters, 3)
    assert np.array_equal(again.vertices, meshes[3].vertices)


def test_bumps_stay_within_their_share_of_the_bevel() -> None:
    w, share = 0.1, 0.4
    bumpy = make_plate(flat(bevel_width=w, bevel_segments=4, mutation_bevel=share), 1).vertices
    smooth = make_plate(flat(bevel_width=w, bevel_segments=4, mutation_bevel=1e-12), 1).vertices
    moved = np.linalg.norm(bumpy - smooth, axis=1)
    assert moved.max() <= share * w + 1e-12
    assert_uniform(moved[moved > 0], 0.0, share * w + 1e-12, bins=20)
    # Top, bottom and upright sides stay plane: only the vertices between them move.
    on_flat = np.isclose(smooth[:, 2], 0) | (smooth[:, 2] <= -w + 1e-12)
    assert not moved[on_flat].any()
    assert moved[~on_flat].all()
