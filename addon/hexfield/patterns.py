# SPDX-License-Identifier: GPL-3.0-or-later
"""How plates lie: the patterns that a layout is made of. Plain numpy."""

import dataclasses
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from .ground import Ground, MeshGround
from .noise import Floats, Integers
from .parameters import MOST_RINGS, FieldParameters
from .scatter import scatter


@dataclasses.dataclass(frozen=True)
class Cells:
    """n places for plates. The pair of identities is a cell's own, however large the field is."""

    x: Floats
    y: Floats
    identity: tuple[Integers, Integers]
    ring: Integers  # around the middle, from 0
    turn: Floats | None = None  # about the axis, in radians
    # On a mesh, whose relief stands already: (n) heights and (n, 3) unit normals.
    z: Floats | None = None
    normal: Floats | None = None

    def __len__(self) -> int:
        return len(self.x)


def spacing(parameters: FieldParameters) -> float:
    """From the centre of a plate to that of its neighbour."""
    return float(np.sqrt(3.0) * parameters.plate_radius + parameters.gap)


def ring_distance(parameters: FieldParameters) -> float:
    """Ring k of hexagons has its nearest centres, the middles of its sides, at k times this."""
    return spacing(parameters) * float(np.sqrt(0.75))


def _rings(parameters: FieldParameters) -> int:
    if parameters.extent == "RINGS":
        return parameters.rings
    step = spacing(parameters) if parameters.pattern == "CIRCLES" else ring_distance(parameters)
    return int(parameters.radius / step)


def check(parameters: FieldParameters) -> None:
    """Raises ValueError for a field of more plates than anybody can mean, or for more ground than a planet has."""
    if parameters.extent == "RADIUS" and _rings(parameters) > MOST_RINGS:
        farthest = MOST_RINGS * ring_distance(parameters)
        raise ValueError(
            f"hexagon field: radius is {parameters.radius:g}; allowed with plates of this size: 0 to {farthest:g}"
        )
    if parameters.planet_radius > 0.0:
        reach = parameters.radius if parameters.extent == "RADIUS" else parameters.rings * spacing(parameters)
        if reach > 0.5 * np.pi * parameters.planet_radius:
            raise ValueError(
                f"hexagon field: planet_radius is {parameters.planet_radius:g}; allowed for a field that reaches"
                f" {reach:g} far: from {2.0 / np.pi * reach:g} up, or 0"
            )


def cells(parameters: FieldParameters, ground: Ground | None = None) -> Cells:
    """Those within the extent and the sector and outside the clearing."""
    check(parameters)
    found = PATTERNS[parameters.pattern](parameters, ground)
    keep = None
    if parameters.clearing > 0 and parameters.pattern != "CIRCLES":  # whose first runs around it
        keep = np.hypot(found.x, found.y) >= parameters.clearing + parameters.plate_radius
    if parameters.sector < 2.0 * np.pi - 1e-6:
        away = np.arctan2(-found.x, found.y) - parameters.sector_direction
        inside = np.abs((away + np.pi) % (2.0 * np.pi) - np.pi) <= 0.5 * parameters.sector
        keep = inside if keep is None else keep & inside
    return found if keep is None else _some(found, keep)


def _some(all_cells: Cells, keep: NDArray[np.bool_]) -> Cells:
    def part(values: Floats | None) -> Floats | None:
        return None if values is None else values[keep]

    q, r = all_cells.identity
    return Cells(
        all_cells.x[keep],
        all_cells.y[keep],
        (q[keep], r[keep]),
        all_cells.ring[keep],
        part(all_cells.turn),
        part(all_cells.z),
        part(all_cells.normal),
    )


def _hexagons(parameters: FieldParameters, _ground: Ground | None) -> Cells:
    """Axial coordinates are the identities. The corners of a plate stand at 0, 60, ... degrees, so its neighbours lie
    at 30, 90, ..."""
    rings = _rings(parameters)
    axis = np.arange(-rings, rings + 1, dtype=np.int64)
    q, r = (grid.ravel() for grid in np.meshgrid(axis, axis))
    ring = np.maximum(np.maximum(np.abs(q), np.abs(r)), np.abs(q + r))
    inside = ring <= rings
    q, r, ring = q[inside], r[inside], ring[inside]
    step = spacing(parameters)
    x, y = step * np.sqrt(0.75) * q, step * (0.5 * q + r)
    if parameters.extent == "RADIUS":
        near = np.hypot(x, y) <= parameters.radius
        q, r, ring, x, y = q[near], r[near], ring[near], x[near], y[near]
    return Cells(x, y, (q, r), ring)


def _circles(parameters: FieldParameters, _ground: Ground | None) -> Cells:
    """The first circle runs around the clearing; without one, a plate stands in the middle. Corners point outwards."""
    step = spacing(parameters)
    inner = parameters.clearing + parameters.plate_radius if parameters.clearing > 0 else 0.0
    number: Integers = np.arange(_rings(parameters) + 1, dtype=np.int64)
    radius: Floats = inner + number.astype(np.float64) * step
    if parameters.extent == "RADIUS":
        number, radius = number[radius <= parameters.radius], radius[radius <= parameters.radius]
    count = np.maximum((2.0 * np.pi * radius / step).astype(np.int64), 1)
    ring = np.repeat(number, count)
    place = np.arange(len(ring)) - np.repeat(np.cumsum(count) - count, count)
    # Every other circle is turned by half a plate, as bricks are laid.
    angle = 2.0 * np.pi * (place + 0.5 * (ring % 2)) / np.repeat(count, count)
    far = np.repeat(radius, count)
    return Cells(far * np.cos(angle), far * np.sin(angle), (ring, place), ring, turn=angle)


def _scattered(parameters: FieldParameters, ground: Ground | None) -> Cells:
    """On the triangles of a mesh, or on the square around the disc that the extent gives."""
    step = spacing(parameters)
    reach = parameters.radius if parameters.extent == "RADIUS" else parameters.rings * step
    on_mesh = isinstance(ground, MeshGround)
    if on_mesh:
        triangles = ground.triangles  # type: ignore[union-attr]
    else:
        corners = reach * np.array([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]])
        triangles = corners[np.array([[0, 1, 2], [0, 2, 3]])]
    most = 3 * MOST_RINGS * (MOST_RINGS + 1)
    points, normal = scatter(triangles, 2.0 * parameters.plate_radius + parameters.gap, parameters.seed, most)
    number = np.arange(len(points))
    far = np.hypot(points[:, 0], points[:, 1])
    found = Cells(
        points[:, 0].copy(),
        points[:, 1].copy(),
        (number, np.full_like(number, -1)),
        (far / step).astype(np.int64),
        z=points[:, 2].copy() if on_mesh else None,
        normal=normal if on_mesh else None,
    )
    return found if on_mesh else _some(found, far <= reach)


PATTERNS: dict[str, Callable[[FieldParameters, Ground | None], Cells]] = {
    "HEXAGONS": _hexagons,
    "CIRCLES": _circles,
    "SCATTER": _scattered,
}
