# SPDX-License-Identifier: GPL-3.0-or-later
"""The mesh of one bevelled hexagonal plate, and its mutants: plain numpy."""

import dataclasses
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
_RADIAL, _ANGULAR, _DENT, _BUMP = range(100, 104)


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
    sixths of cylinders.
    """
    apothem = np.sqrt(0.75) * parameters.plate_radius
    width = min(parameters.bevel_width, 0.9 * apothem, 0.9 * parameters.thickness)
    segments = parameters.bevel_segments if width > 0 else 0
    corners, drop = _corners(parameters, prototype, apothem - width, parameters.thickness - width)
    steps = _edge_steps(parameters, width, segments)
    base, base_drop, normals, corner_of = _outline(corners, drop, segments, steps)

    # Rims from the upright side (0) to the top (segments); on the top one all samples of a corner are one vertex.
    samples = len(base)
    top_samples = np.unique(corner_of)
    rims: list[Integers] = [np.arange(samples) + j * samples for j in range(segments)]
    rims.append(segments * samples + np.searchsorted(top_samples, corner_of))
    vertices = []
    for j in range(segments):
        angle = 0.5 * np.pi * j / segments
        bump = np.zeros(samples)
        if j > 0 and parameters.mutation_bevel > 0:
            which = np.arange(samples) + samples * j
            random = random_unit(which, np.full(samples, prototype), parameters.seed, _BUMP)
            bump = parameters.mutation_bevel * width * (2 * random - 1)
        out = (width + bump) * np.cos(angle)
        up = (width + bump) * np.sin(angle) - width
        vertices.append(np.column_stack([base + out[:, np.newaxis] * normals, up - base_drop]))
    vertices.append(np.column_stack([base[top_samples], -base_drop[top_samples]]))

    first_of_corner = np.arange(6) * (samples // 6)
    arcs = (first_of_corner[:, np.newaxis] + np.arange(segments + 1)).ravel()
    foot = np.full(samples, -1)
    foot[arcs] = sum(map(len, vertices)) + np.arange(len(arcs))
    vertices.append(np.column_stack([(base + width * normals)[arcs], np.full(len(arcs), -parameters.thickness)]))
    centre = sum(map(len, vertices))
    vertices.append(np.zeros((1, 3)))

    bevel = [*_bands(rims), *_upright_edges(rims[0], foot, first_of_corner, segments)]
    flat = [*_flats(rims, foot, first_of_corner, segments, centre), foot[arcs][::-1]]
    return _assemble(np.concatenate(vertices), flat, bevel, parameters.bevel_smooth)


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


def _outline(corners: Floats, drop: Floats, segments: int, steps: int) -> tuple[Floats, Floats, Floats, Integers]:
    """The samples counter-clockwise around the flat part, segments + steps of them a corner: first segments + 1 that
    turn about the corner, then the inner points of the edge that follows. Returns points (m, 2), drops (m), outward
    normals (m, 2) and the sample that stands for each on the top rim (m).
    """
    after = np.roll(corners, -1, axis=0)
    edge_angle = np.arctan2(-(after - corners)[:, 0], (after - corners)[:, 1])
    turn = (edge_angle - np.roll(edge_angle, 1)) % (2 * np.pi)
    share = np.arange(segments + 1) / segments if segments else np.ones(1)
    along = np.arange(1, steps) / steps
    points, drops, angles, representatives = [], [], [], []
    for k in range(6):
        start = k * (segments + steps)
        points += [corners[k]] * (segments + 1) + [corners[k] + t * (after[k] - corners[k]) for t in along]
        drops += [drop[k]] * (segments + 1) + [drop[k] + t * (drop[(k + 1) % 6] - drop[k]) for t in along]
        angles += list(edge_angle[k] - turn[k] * (1 - share)) + [edge_angle[k]] * (steps - 1)
        representatives += [start] * (segments + 1) + [start + segments + i for i in range(1, steps)]
    angle = np.array(angles)
    return np.array(points), np.array(drops), np.column_stack([np.cos(angle), np.sin(angle)]), np.array(representatives)


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
    """Six sides and the six sectors of the top, each a plane polygon."""
    samples = len(rims[0])
    for k in range(6):
        begin, end = first_of_corner[k] + segments, first_of_corner[(k + 1) % 6] + (samples if k == 5 else 0)
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
