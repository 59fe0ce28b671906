# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the plates of a hexagon field stand: plain numpy, repeatable by seed."""

import dataclasses
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .ground import Ground
from .noise import Floats, random_unit
from .parameters import FieldParameters
from .patterns import Cells, cells, check, spacing
from .plate import Kind, kinds
from .relief import relief

__all__ = ["FieldLayout", "check", "euler_to_matrix", "lay_out", "spacing"]

# Independent sets of random numbers, one a purpose; gradient noise uses those from 1000.
_HEIGHT, _TILT, _TILT_DIRECTION, _TURN, _SIZE, _PROTOTYPE, _MISSING, _SUNKEN, _SINK, _CRACKED, _OWN = range(11)
_CHUNK = 1 << 14  # plates that are laid out at once: what they need stays in a core's cache

Matrix = list[list[Any]]  # 3 x 3, of numbers or of (n) each


@dataclasses.dataclass(frozen=True)
class FieldLayout:
    """n plates. The origin of a plate is the middle of its top."""

    positions: Floats  # (n, 3)
    rotations: Floats  # (n, 3), Euler angles in radians, order XYZ: R = Rz Ry Rx
    scales: Floats  # (n, 3)
    prototypes: NDArray[np.int32]  # (n), which of the prototypes, from 0
    randoms: Floats  # (n), a number of each plate's own in [0, 1), that nothing else here depends on
    rings: NDArray[np.int32]  # (n), around the middle, from 0
    heights: Floats  # (n), of the ground over the plane, or over the planet
    steepness: Floats  # (n), the tangent of the ground's slope
    places: Floats  # (n, 2), along the ground: where noise is to be looked up

    def __len__(self) -> int:
        return len(self.prototypes)


def lay_out(parameters: FieldParameters, ground: Ground | None = None) -> FieldLayout:
    """The plates, row by row. What is random about a plate depends on the seed and its cell alone, so that a field
    that grows keeps the plates it had; scattered ones are numbered, and do not. ground: what they stand on in place of
    a plane. Raises ValueError as check() does.
    """
    found = cells(parameters, ground)
    n = len(found)
    rows: dict[str, Floats] = {name: np.empty((n, 3)) for name in ("positions", "rotations")}
    rows |= {name: np.empty(n) for name in ("sizes", "randoms", "heights", "steepness")}
    prototypes: NDArray[np.int32] = np.empty(n, np.int32)
    there: NDArray[np.bool_] = np.ones(n, dtype=bool)
    for begin in range(0, n, _CHUNK):
        part = slice(begin, begin + _CHUNK)
        chunk, there[part] = _plates(_slice(found, part), parameters, ground)
        prototypes[part] = chunk.pop("prototypes")
        for name, values in chunk.items():
            rows[name][part] = values
    places, rings = np.stack([found.x, found.y], axis=1), found.ring.astype(np.int32)
    if not there.all():
        rows = {name: values[there] for name, values in rows.items()}
        prototypes, places, rings = prototypes[there], places[there], rings[there]
    sizes = rows.pop("sizes")
    return FieldLayout(
        **rows,
        scales=np.broadcast_to(sizes[:, np.newaxis], (len(sizes), 3)),
        prototypes=prototypes,
        rings=rings,
        places=places,
    )


def _slice(found: Cells, part: slice) -> Cells:
    def of(values: Any) -> Any:
        return None if values is None else values[part]

    first, second = found.identity
    return Cells(
        found.x[part],
        found.y[part],
        (first[part], second[part]),
        found.ring[part],
        of(found.turn),
        of(found.z),
        of(found.normal),
    )


def _plates(
    found: Cells, parameters: FieldParameters, ground: Ground | None
) -> tuple[dict[str, Any], NDArray[np.bool_]]:
    """What a FieldLayout holds of these cells, but for what they hold themselves; and which of them have a plate."""

    def random(stream: int) -> Floats:
        return random_unit(*found.identity, parameters.seed, stream)

    x, y = found.x, found.y
    there: NDArray[np.bool_] = np.ones(len(found), dtype=bool)
    base = None
    if ground is not None and found.normal is None:
        there, base = ground.at(x, y)
    z, slope_x, slope_y = relief(x, y, parameters, base)
    heights = z
    if parameters.mutation_height > 0:
        z = z + parameters.mutation_height * (2 * random(_HEIGHT) - 1)
    if parameters.sunken > 0 and parameters.sunken_depth > 0:
        z = z - np.where(random(_SUNKEN) < parameters.sunken, parameters.sunken_depth * random(_SINK), 0.0)
    if parameters.missing > 0:
        there = there & (random(_MISSING) >= parameters.missing)
    steepness = np.hypot(slope_x, slope_y)
    rotation = _rotation(found, parameters, (slope_x, slope_y, steepness), random)
    size: Any = 1 - parameters.mutation_size * random(_SIZE) if parameters.mutation_size > 0 else np.ones(len(found))
    if found.normal is not None and found.z is not None:
        frame = _frame(found.normal)
        rotation = _product(frame, rotation)
        positions = np.stack([x, y, found.z], axis=1) + z[:, np.newaxis] * found.normal
        heights, steepness = found.z + z, np.hypot(found.normal[:, 0], found.normal[:, 1])
        steepness = steepness / np.maximum(np.abs(found.normal[:, 2]), 1e-6)
    elif parameters.planet_radius > 0:
        positions, rotation, shrink = _on_planet(x, y, z, rotation, parameters.planet_radius)
        size = size * shrink
    else:
        positions = np.stack([x, y, z], axis=1)
    chunk = {
        "positions": positions,
        "rotations": _euler(rotation, len(found)),
        "sizes": size,
        "randoms": random(_OWN),
        "heights": heights,
        "steepness": steepness,
        "prototypes": _prototypes(parameters, random),
    }
    return chunk, there


def _prototypes(parameters: FieldParameters, random: Any) -> NDArray[np.int32]:
    # The last choice can only come up by rounding of a number close to 1.
    which = np.minimum((random(_PROTOTYPE) * parameters.prototypes).astype(np.int32), parameters.prototypes - 1)
    if parameters.cracked > 0:
        cracked = kinds(parameters).index(Kind.CRACKED) * parameters.prototypes
        which = which + np.where(random(_CRACKED) < parameters.cracked, np.int32(cracked), np.int32(0))
    return np.asarray(which, np.int32)


def _rotation(found: Cells, parameters: FieldParameters, slope: tuple[Floats, Floats, Floats], random: Any) -> Matrix:
    """Of plates on a plane: first turned about their axis, then tilted, then leant with the hill."""
    slope_x, slope_y, steepness = slope
    rotation: Matrix = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    turn = found.turn
    if parameters.mutation_turn > 0:
        own = parameters.mutation_turn * (2 * random(_TURN) - 1)
        turn = own if turn is None else turn + own
    if turn is not None:
        c, s = np.cos(turn), np.sin(turn)
        rotation = [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]
    if parameters.mutation_tilt > 0:
        tilt = parameters.mutation_tilt * random(_TILT)
        direction = 2 * np.pi * random(_TILT_DIRECTION)
        rotation = _product(_lean(np.cos(direction), np.sin(direction), np.cos(tilt), np.sin(tilt)), rotation)
    if parameters.hill_follow > 0:
        angle = np.arctan(steepness) * parameters.hill_follow
        safe = np.maximum(steepness, 1e-300)
        rotation = _product(_lean(-slope_x / safe, -slope_y / safe, np.cos(angle), np.sin(angle)), rotation)
    return rotation


def _on_planet(x: Floats, y: Floats, z: Floats, rotation: Matrix, radius: float) -> tuple[Floats, Matrix, Floats]:
    """Places, rotations and by what plates are smaller, for a plane wrapped around a sphere that it touches at the
    origin: distances from there stay (the azimuthal equidistant projection), those across it shrink.
    """
    distance = np.hypot(x, y)
    angle = distance / radius
    safe = np.maximum(distance, 1e-300)
    out_x, out_y = x / safe, y / safe
    c, s = np.cos(angle), np.sin(angle)
    along = (radius + z) * s
    # radius (cos - 1) without the digits that the difference loses.
    down = -2.0 * radius * np.sin(0.5 * angle) ** 2
    positions = np.stack([along * out_x, along * out_y, down + z * c], axis=1)
    shrink = np.where(angle > 1e-8, s / np.maximum(angle, 1e-8), 1.0)
    return positions, _product(_lean(out_x, out_y, c, s), rotation), shrink


def _frame(normal: Floats) -> Matrix:
    """Rotations that take the z axis to (n, 3) unit normals, by the shortest way."""
    x, y, z = normal.T
    flat = np.hypot(x, y)
    upright = flat < 1e-12
    safe = np.where(upright, 1.0, flat)
    return _lean(np.where(upright, 1.0, x / safe), np.where(upright, 0.0, y / safe), z, flat)


def _lean(x: Any, y: Any, c: Any, s: Any) -> Matrix:
    """Rotations by an angle of this cosine and sine about the horizontal axis that takes the z axis towards the
    horizontal unit vector (x, y) (Rodrigues).
    """
    k = 1 - c
    kx, ky = k * x, k * y
    mixed = -kx * y
    return [[c + ky * y, mixed, s * x], [mixed, c + kx * x, s * y], [-s * x, -s * y, c]]


def _product(a: Matrix, b: Matrix) -> Matrix:
    """a b, without multiplications by the numbers 0 and 1, and to the same last bit wherever arrays lie in memory."""

    def times(one: Any, other: Any) -> Any:
        for first, second in ((one, other), (other, one)):
            if isinstance(first, float):
                return 0.0 if first == 0.0 else second if first == 1.0 else first * second
        return one * other

    def dot(row: list[Any], column: int) -> Any:
        total: Any = 0.0
        for k in range(3):
            part = times(row[k], b[k][column])
            total = part if isinstance(total, float) and total == 0.0 else total + part
        return total

    return [[dot(row, column) for column in range(3)] for row in a]


def _euler(rotation: Matrix, count: int) -> Floats:
    """(n, 3): the XYZ Euler angles of rotations that keep the x axis off the vertical, as hills and tilts below 90
    degrees do for all but a null set.
    """
    if all(isinstance(rotation[i][j], float) for i, j in ((2, 0), (2, 1), (1, 0))):
        return np.zeros((count, 3))
    y = -np.arcsin(np.clip(rotation[2][0], -1, 1))
    x = np.arctan2(rotation[2][1], rotation[2][2])
    z = np.arctan2(rotation[1][0], rotation[0][0])
    return np.stack([np.broadcast_to(angle, (count,)) for angle in (x, y, z)], axis=1)


def euler_to_matrix(angles: Floats) -> Floats:
    """(n, 3, 3) rotations Rz Ry Rx of (n, 3) Euler angles."""
    (cx, cy, cz), (sx, sy, sz) = np.cos(angles).T, np.sin(angles).T
    rows = [
        [cy * cz, sx * sy * cz - cx * sz, cx * sy * cz + sx * sz],
        [cy * sz, sx * sy * sz + cx * cz, cx * sy * sz - sx * cz],
        [-sy, sx * cy, cx * cy],
    ]
    return np.moveaxis(np.array(rows), 2, 0)
