# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the plates of a hexagon field stand: plain numpy, repeatable by seed."""

import dataclasses

import numpy as np
from numpy.typing import NDArray

from .noise import hills, random_unit
from .parameters import MOST_RINGS, FieldParameters

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

# Independent sets of random numbers, one a purpose; gradient noise uses those from 1000.
_HEIGHT, _TILT, _TILT_DIRECTION, _TURN, _SIZE, _PROTOTYPE = range(6)


@dataclasses.dataclass(frozen=True)
class FieldLayout:
    """n plates. The origin of a plate is the middle of its top."""

    positions: Floats  # (n, 3)
    rotations: Floats  # (n, 3), Euler angles in radians, order XYZ: R = Rz Ry Rx
    scales: Floats  # (n, 3)
    prototypes: NDArray[np.int32]  # (n), which of the prototypes, from 0

    def __len__(self) -> int:
        return len(self.prototypes)


def lay_out(parameters: FieldParameters) -> FieldLayout:
    """The plates, row by row. What is random about a plate depends on the seed and its cell alone, so that a field
    that grows keeps the plates it had. Raises ValueError as check() does.
    """
    check(parameters)
    q, r = _cells(parameters)
    x, y = _centres(q, r, parameters)
    if parameters.clearing > 0:
        kept = np.hypot(x, y) >= parameters.clearing + parameters.plate_radius
        q, r, x, y = q[kept], r[kept], x[kept], y[kept]

    def random(stream: int) -> Floats:
        return random_unit(q, r, parameters.seed, stream)

    z, slope_x, slope_y = np.zeros_like(x), np.zeros_like(x), np.zeros_like(x)
    if parameters.hill_height > 0:
        noise = hills(x, y, parameters.hill_wavelength, parameters.hill_octaves, parameters.seed)
        z, slope_x, slope_y = (parameters.hill_height * part for part in noise)
    if parameters.mutation_height > 0:
        z = z + parameters.mutation_height * (2 * random(_HEIGHT) - 1)

    tilt = parameters.mutation_tilt * random(_TILT)
    direction = 2 * np.pi * random(_TILT_DIRECTION)
    turn = parameters.mutation_turn * (2 * random(_TURN) - 1)
    size = 1 - parameters.mutation_size * random(_SIZE)
    follow = np.arctan(np.hypot(slope_x, slope_y)) * parameters.hill_follow
    downhill = np.arctan2(-slope_y, -slope_x)
    rotation = _product(_product(_lean(downhill, follow), _lean(direction, tilt)), _turn(turn))

    # The last choice can only come up by rounding of a number close to 1.
    prototypes = np.minimum((random(_PROTOTYPE) * parameters.prototypes).astype(np.int32), parameters.prototypes - 1)
    return FieldLayout(
        positions=np.stack([x, y, z], axis=1),
        rotations=_euler(rotation),
        scales=np.repeat(size[:, np.newaxis], 3, axis=1),
        prototypes=prototypes.astype(np.int32),
    )


def check(parameters: FieldParameters) -> None:
    """Raises ValueError for a field of more plates than anybody can mean."""
    if parameters.extent == "RADIUS" and _rings_within(parameters) > MOST_RINGS:
        farthest = MOST_RINGS * _ring_distance(parameters)
        raise ValueError(
            f"hexagon field: radius is {parameters.radius:g}; allowed with plates of this size: 0 to {farthest:g}"
        )


def spacing(parameters: FieldParameters) -> float:
    """From the centre of a plate to that of its neighbour."""
    return float(np.sqrt(3.0) * parameters.plate_radius + parameters.gap)


def _ring_distance(parameters: FieldParameters) -> float:
    """Ring k has its nearest centres, the middles of its sides, at k times this."""
    return spacing(parameters) * float(np.sqrt(0.75))


def _rings_within(parameters: FieldParameters) -> int:
    return int(parameters.radius / _ring_distance(parameters))


def _cells(parameters: FieldParameters) -> tuple[Integers, Integers]:
    """Axial coordinates of the cells within the extent, each (n)."""
    rings = parameters.rings if parameters.extent == "RINGS" else _rings_within(parameters)
    axis = np.arange(-rings, rings + 1, dtype=np.int64)
    q, r = (grid.ravel() for grid in np.meshgrid(axis, axis))
    inside = np.abs(q + r) <= rings
    q, r = q[inside], r[inside]
    if parameters.extent == "RADIUS":
        x, y = _centres(q, r, parameters)
        near = np.hypot(x, y) <= parameters.radius
        q, r = q[near], r[near]
    return q, r


def _centres(q: Integers, r: Integers, parameters: FieldParameters) -> tuple[Floats, Floats]:
    """The corners of a plate stand at 0, 60, ... degrees, so its neighbours lie at 30, 90, ..."""
    step = spacing(parameters)
    u, v = q.astype(np.float64), r.astype(np.float64)
    return step * np.sqrt(0.75) * u, step * (0.5 * u + v)


def _lean(direction: Floats, angle: Floats) -> Floats:
    """(n, 3, 3): rotations by `angle` about the horizontal axis that takes the z axis towards `direction`
    (Rodrigues).
    """
    ax, ay = -np.sin(direction), np.cos(direction)
    c, s = np.cos(angle), np.sin(angle)
    k = 1 - c
    rows = [[c + k * ax * ax, k * ax * ay, s * ay], [k * ax * ay, c + k * ay * ay, -s * ax], [-s * ay, s * ax, c]]
    return np.moveaxis(np.array(rows), 2, 0)


def _turn(angle: Floats) -> Floats:
    """(n, 3, 3): rotations about the z axis."""
    c, s, zero, one = np.cos(angle), np.sin(angle), np.zeros_like(angle), np.ones_like(angle)
    return np.moveaxis(np.array([[c, -s, zero], [s, c, zero], [zero, zero, one]]), 2, 0)


def _product(a: Floats, b: Floats) -> Floats:
    """a @ b for (n, 3, 3), to the same last bit wherever the arrays lie in memory: matmul may take another route."""
    return np.asarray(np.einsum("nij,njk->nik", a, b))


def _euler(rotation: Floats) -> Floats:
    """(n, 3): the XYZ Euler angles of (n, 3, 3) rotations that keep the x axis off the vertical, as hills and tilts
    below 90 degrees do for all but a null set.
    """
    y = -np.arcsin(np.clip(rotation[:, 2, 0], -1, 1))
    x = np.arctan2(rotation[:, 2, 1], rotation[:, 2, 2])
    z = np.arctan2(rotation[:, 1, 0], rotation[:, 0, 0])
    return np.stack([x, y, z], axis=1)


def euler_to_matrix(angles: Floats) -> Floats:
    """(n, 3, 3) rotations Rz Ry Rx of (n, 3) Euler angles."""
    (cx, cy, cz), (sx, sy, sz) = np.cos(angles).T, np.sin(angles).T
    rows = [
        [cy * cz, sx * sy * cz - cx * sz, cx * sy * cz + sx * sz],
        [cy * sz, sx * sy * sz + cx * cz, cx * sy * sz - sx * cz],
        [-sy, sx * cy, cx * cy],
    ]
    return np.moveaxis(np.array(rows), 2, 0)
