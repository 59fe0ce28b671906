# SPDX-License-Identifier: GPL-3.0-or-later
"""The mesh of one bevelled hexagonal plate, and its mutants: plain numpy."""

import dataclasses
import enum
import itertools
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from .noise import random_unit
from .parameters import FieldParameters

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

PLATE_SLOT, BEVEL_SLOT = 0, 1

# Independent sets of random numbers; every prototype has its own place in them.
_RADIAL, _ANGULAR, _DENT, _BUMP, _CRACK, _CRACK_PLACE, _SECOND_CRACK = range(100, 107)
_PIECES = 1000  # between the random numbers of one piece of a broken plate and those of the next


class Kind(enum.Enum):
    """In what ways the variants of a plate come."""

    WHOLE = enum.auto()
    CRACKED = enum.auto()
    SIMPLE = enum.auto()  # for plates far away


def kinds(parameters: FieldParameters) -> list[Kind]:
    """Prototype number k * prototypes + i is variant i of the k-th of these."""
    found = [Kind.WHOLE]
    if parameters.cracked > 0:
        found.append(Kind.CRACKED)
    if parameters.simplify:
        found.append(Kind.SIMPLE)
    return found


def prototype_count(parameters: FieldParameters) -> int:
    return parameters.prototypes * len(kinds(parameters))


@dataclasses.dataclass(frozen=True)
class PlateMesh:
    """A closed mesh, faces counter-clockwise seen from outside. The origin is the middle of the top, the z axis goes
    up.
    """

    vertices: Floats  # (v, 3)
    face_vertices: NDArray[np.int32]  # (sum of the faces' sizes)
    face_sizes: NDArray[np.int32]  # (f)
    slots: NDArray[np.int32]  # (f), PLATE_SLOT: top, sides and bottom; BEVEL_SLOT: the rounded edges
    smooth: NDArray[np.bool_]  # (f)

    @property
    def face_starts(self) -> NDArray[np.int32]:
        return np.concatenate([[0], np.cumsum(self.face_sizes)[:-1]]).astype(np.int32)


def make_plate(parameters: FieldParameters, prototype: int) -> PlateMesh:
    """A plate is the sum (Minkowski's) of a flat hexagon and a sphere of the bevel's width, continued downwards to a
    sharp edge at the bottom: its top edges are quarter cylinders, its corners eighths of spheres, its upright edges
    sixths of cylinders. The pieces of a cracked one are such sums of what the cracks leave of the hexagon.
    """
    kind, variant = kinds(parameters)[prototype // parameters.prototypes], prototype % parameters.prototypes
    if kind is Kind.SIMPLE:
        parameters = dataclasses.replace(parameters, bevel_segments=1, mutation_bevel=0.0)
    apothem = np.sqrt(0.75) * parameters.plate_radius
    width = min(parameters.bevel_width, 0.9 * apothem, 0.9 * parameters.thickness)
    corners, drop = _corners(parameters, variant, apothem - width, parameters.thickness - width)
    if kind is not Kind.CRACKED:
        return _make_piece(parameters, variant, width, corners, drop, np.zeros(3))
    pieces = []
    for number, piece in enumerate(_pieces(parameters, variant, width, corners, drop)):
        middle = piece.mean(axis=0)
        # A piece lies a little lower than its neighbour, or higher, as rubble does.
        sink = 0.15 * min(parameters.thickness, parameters.plate_radius) * number * (1 if variant % 2 else -1)
        pieces.append(
            _make_piece(
                parameters, variant + _PIECES * (number + 1), width, piece[:, :2], piece[:, 2] - min(sink, 0.0), middle
            )
        )
    return _joined(pieces)


def _pieces(parameters: FieldParameters, variant: int, width: float, corners: Floats, drop: Floats) -> list[Floats]:
    """What one or two straight cracks leave of the flat part: (k, 3) corners and drops of each piece."""
    which = np.array([variant])
    first, place, second = (
        float(random_unit(which, which, parameters.seed, stream)[0]) for stream in (_CRACK, _CRACK_PLACE, _SECOND_CRACK)
    )
    flat = np.column_stack([corners, drop])
    # Never along a corner's direction for all variants alike, and never so far out that a sliver is left.
    angle, offset = np.pi * first, 0.3 * (2.0 * place - 1.0) * parameters.plate_radius
    room = width + 0.5 * parameters.crack_width
    direction = np.array([np.cos(angle), np.sin(angle)])
    halves = [_clipped(flat, direction, offset - room), _clipped(flat, -direction, -offset - room)]
    pieces = halves
    if second < 0.5:
        turned = np.array([np.cos(angle + 1.0 + second), np.sin(angle + 1.0 + second)])
        quarters = [_clipped(halves[0], turned, -room), _clipped(halves[0], -turned, -room)]
        if all(len(piece) >= 3 for piece in quarters):
            pieces = [*quarters, halves[1]]
    pieces = [piece for piece in pieces if len(piece) >= 3]
    return pieces or [flat]


def _clipped(polygon: Floats, direction: Floats, limit: float) -> Floats:
    """The part of a convex polygon (k, 3) whose first two coordinates lie no further than `limit` along a direction
    (Sutherland and Hodgman 1974); less than three corners where nothing worth a piece is left.
    """
    if len(polygon) == 0:
        return polygon
    beyond = polygon[:, :2] @ direction - limit
    found = []
    for k in range(len(polygon)):
        after = (k + 1) % len(polygon)
        if beyond[k] <= 0:
            found.append(polygon[k])
        if (beyond[k] <= 0) != (beyond[after] <= 0):
            share = beyond[k] / (beyond[k] - beyond[after])
            found.append(polygon[k] + share * (polygon[after] - polygon[k]))
    size = np.abs(polygon[:, :2]).max()
    apart = [p for i, p in enumerate(found) if np.linalg.norm(p[:2] - found[i - 1][:2]) > 1e-3 * size]
    area = 0.5 * sum(float(a[0] * b[1] - a[1] * b[0]) for a, b in zip(apart, apart[1:] + apart[:1], strict=True))
    return np.array(apart) if len(apart) >= 3 and area > 0.01 * size * size else np.empty((0, 3))


def _make_piece(
    parameters: FieldParameters, variant: int, width: float, corners: Floats, drop: Floats, middle: Floats
) -> PlateMesh:
    """corners: (k, 2) of the flat part, counter-clockwise; drop: (k), how far each lies below the plate's origin;
    middle: the same two numbers and the drop of a point of the top within."""
    segments = parameters.bevel_segments if width > 0 else 0
    steps = _edge_steps(parameters, width, segments)
    base, base_drop, normals, corner_of, first_of_corner = _outline(corners, drop, segments, steps)

    # Rims from the upright side (0) to the top (segments); on the top one all samples of a corner are one vertex.
    samples = len(base)
    top_samples = np.unique(corner_of)
    rims: list[Integers] = [np.arange(samples) + j * samples for j in range(segments)]
    rims.append(segments * samples + np.searchsorted(top_samples, corner_of))
    vertices = []
    for j in range(segments):
        angle = 0.5 * np.pi * j / segments
        bump: Floats = np.zeros(samples)
        if j > 0 and parameters.mutation_bevel > 0:
            which = np.arange(samples) + samples * j
            random = random_unit(which, np.full(samples, variant), parameters.seed, _BUMP)
            bump = parameters.mutation_bevel * width * (2 * random - 1)
        out = (width + bump) * np.cos(angle)
        up = (width + bump) * np.sin(angle) - width
        vertices.append(np.column_stack([base + out[:, np.newaxis] * normals, up - base_drop]))
    vertices.append(np.column_stack([base[top_samples], -base_drop[top_samples]]))

    arcs = (first_of_corner[:, np.newaxis] + np.arange(segments + 1)).ravel()
    foot = np.full(samples, -1)
    foot[arcs] = sum(map(len, vertices)) + np.arange(len(arcs))
    vertices.append(np.column_stack([(base + width * normals)[arcs], np.full(len(arcs), -parameters.thickness)]))
    centre = sum(map(len, vertices))
    vertices.append(np.array([[middle[0], middle[1], -middle[2]]]))

    bevel = [*_bands(rims), *_upright_edges(rims[0], foot, first_of_corner, segments)]
    flat = [*_flats(rims, foot, first_of_corner, segments, centre), foot[arcs][::-1]]
    return _assemble(np.concatenate(vertices), flat, bevel, parameters.bevel_smooth)


def _joined(pieces: list[PlateMesh]) -> PlateMesh:
    starts = np.cumsum([0, *(len(piece.vertices) for piece in pieces)])
    return PlateMesh(
        vertices=np.concatenate([piece.vertices for piece in pieces]),
        face_vertices=np.concatenate(
            [piece.face_vertices + start for piece, start in zip(pieces, starts, strict=False)]
        ).astype(np.int32),
        face_sizes=np.concatenate([piece.face_sizes for piece in pieces]),
        slots=np.concatenate([piece.slots for piece in pieces]),
        smooth=np.concatenate([piece.smooth for piece in pieces]),
    )


def _corners(parameters: FieldParameters, prototype: int, apothem: float, depth: float) -> tuple[Floats, Floats]:
    """(6, 2) corners of the flat part and (6) how far each lies below the middle. Corners never leave the regular
    hexagon of that apothem, so that mutants keep their distance, and it stays convex for every shape mutation up to
    0.3.
    """
    k, which = np.arange(6), np.full(6, prototype)
    shape = parameters.mutation_shape
    shift = 0.5 * shape * (2 * random_unit(k, which, parameters.seed, _ANGULAR) - 1)
    pull = shape * random_unit(k, which, parameters.seed, _RADIAL)
    dent = 0.25 * shape * parameters.plate_radius * random_unit(k, which, parameters.seed, _DENT)
    distance = apothem / np.cos(np.pi / 6 - np.abs(shift)) * (1 - pull)
    angle = k * np.pi / 3 + shift
    return np.column_stack([distance * np.cos(angle), distance * np.sin(angle)]), np.minimum(dent, 0.9 * depth)


def _edge_steps(parameters: FieldParameters, width: float, segments: int) -> int:
    """Into how many pieces a straight edge is cut: 1, but for bumps, which want facets at most some times longer than
    wide.
    """
    if parameters.mutation_bevel == 0 or segments < 2:
        return 1
    facet = 0.5 * np.pi * width / segments
    return int(np.clip(round(parameters.plate_radius / (2 * facet)), 1, 16))


def _outline(
    corners: Floats, drop: Floats, segments: int, steps: int
) -> tuple[Floats, Floats, Floats, Integers, Integers]:
    """The samples counter-clockwise around the flat part, segments + steps of them a corner: first segments + 1 that
    turn about the corner, then the inner points of the edge that follows. Returns points (m, 2), drops (m), outward
    normals (m, 2), the sample that stands for each on the top rim (m), and the first of each corner (k).
    """
    after = np.roll(corners, -1, axis=0)
    edge_angle = np.arctan2(-(after - corners)[:, 0], (after - corners)[:, 1])
    turn = (edge_angle - np.roll(edge_angle, 1)) % (2 * np.pi)
    share = np.arange(segments + 1) / segments if segments else np.ones(1)
    along = np.arange(1, steps) / steps
    points, drops, angles, representatives = [], [], [], []
    for k in range(len(corners)):
        start = k * (segments + steps)
        points += [corners[k]] * (segments + 1) + [corners[k] + t * (after[k] - corners[k]) for t in along]
        drops += [drop[k]] * (segments + 1) + [drop[k] + t * (drop[(k + 1) % len(corners)] - drop[k]) for t in along]
        angles += list(edge_angle[k] - turn[k] * (1 - share)) + [edge_angle[k]] * (steps - 1)
        representatives += [start] * (segments + 1) + [start + segments + i for i in range(1, steps)]
    angle = np.array(angles)
    normals = np.column_stack([np.cos(angle), np.sin(angle)])
    starts = np.arange(len(corners)) * (segments + steps)
    return np.array(points), np.array(drops), normals, np.array(representatives), starts


def _bands(rims: list[Integers]) -> Iterable[Integers]:
    """The faces between neighbouring rims; at a corner the topmost are triangles."""
    for lower, upper in itertools.pairwise(rims):
        lower_next, upper_next = np.roll(lower, -1), np.roll(upper, -1)
        for a, b, c, d in zip(lower, lower_next, upper_next, upper, strict=True):
            yield np.array([a, b, c] if c == d else [a, b, c, d])


def _upright_edges(rim: Integers, foot: Integers, first_of_corner: Integers, segments: int) -> Iterable[Integers]:
    for start in first_of_corner:
        for a in range(start, start + segments):
            yield np.array([foot[a], foot[a + 1], rim[a + 1], rim[a]])


def _flats(
    rims: list[Integers], foot: Integers, first_of_corner: Integers, segments: int, centre: int
) -> Iterable[Integers]:
    """The sides and the sectors of the top, each a plane polygon."""
    samples, corners = len(rims[0]), len(first_of_corner)
    for k in range(corners):
        begin = first_of_corner[k] + segments
        end = first_of_corner[(k + 1) % corners] + (samples if k == corners - 1 else 0)
        edge = np.arange(begin, end + 1) % samples
        yield np.concatenate([[foot[edge[0]], foot[edge[-1]]], rims[0][edge][::-1]])
        yield np.concatenate([[centre], rims[-1][edge]])


def _assemble(vertices: Floats, flat: list[Integers], bevel: list[Integers], smooth: bool) -> PlateMesh:
    faces = flat + bevel
    is_bevel = np.arange(len(faces)) >= len(flat)
    return PlateMesh(
        vertices=vertices,
        face_vertices=np.concatenate(faces).astype(np.int32),
        face_sizes=np.array([len(face) for face in faces], dtype=np.int32),
        slots=np.where(is_bevel, BEVEL_SLOT, PLATE_SLOT).astype(np.int32),
        smooth=is_bevel & smooth,
    )
