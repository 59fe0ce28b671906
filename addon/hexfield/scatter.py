# SPDX-License-Identifier: GPL-3.0-or-later
"""Poisson-disc scatter: points at random on triangles, none closer to another than a distance. Plain numpy."""

import numpy as np
from numpy.typing import NDArray

from .ground import expand
from .noise import Floats, Integers, random_unit

_POINT, _SIDE, _ACROSS = range(300, 303)
_ROUNDS = 12
_DENSITY = 0.8  # candidates of a round, for each square of the distance


def scatter(triangles: Floats, distance: float, seed: int, most: int) -> tuple[Floats, Floats]:
    """Places and unit normals, each (n, 3). triangles: (t, 3, 3).

    Darts are thrown in rounds (Cook 1986, "Stochastic sampling in computer graphics"): in each, those too close to what
    stands already are dropped, then those too close to an earlier one of the same round. Gaps that are left are few,
    and smaller than two distances. Raises ValueError where there would be more than `most`.
    """
    edges = triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]
    cross = np.cross(*edges)
    double_area = np.linalg.norm(cross, axis=1)
    reach = np.cumsum(0.5 * double_area)
    if len(reach) == 0 or not reach[-1] > 0:
        return np.empty((0, 3)), np.empty((0, 3))
    count = int(_DENSITY * reach[-1] / distance**2) + 1
    if count > most:
        raise ValueError(f"hexagon field: {count} plates would be scattered; allowed: up to {most}")
    kept, kept_triangle = np.empty((0, 3)), np.empty(0, np.int64)
    for number in range(_ROUNDS):
        index = np.arange(count) + number * count
        zero = np.zeros_like(index)
        pick, s, t = (random_unit(index, zero, seed, stream) for stream in (_POINT, _SIDE, _ACROSS))
        triangle = np.minimum(np.searchsorted(reach, pick * reach[-1], side="right"), len(reach) - 1)
        root = np.sqrt(s)
        points = triangles[triangle, 0] + (root * (1.0 - t))[:, None] * edges[0][triangle]
        points += (root * t)[:, None] * edges[1][triangle]
        free = ~_has_close(points, kept, distance)
        points, triangle = points[free], triangle[free]
        first = _first_come(points, distance)
        kept = np.concatenate([kept, points[first]])
        kept_triangle = np.concatenate([kept_triangle, triangle[first]])
    return kept, cross[kept_triangle] / double_area[kept_triangle, None]


def _first_come(points: Floats, distance: float) -> NDArray[np.bool_]:
    """Which points stay if they come in order and each needs its distance to those before that stay."""
    one, other = _close_pairs(points, points, distance)
    later, earlier = one[other < one], other[other < one]
    stays = np.ones(len(points), dtype=bool)
    decided = np.zeros(len(points), dtype=bool)
    while len(later):
        # A point with no undecided earlier neighbour is decided: it stays, and those close after it go.
        waits = np.zeros(len(points), dtype=bool)
        waits[later[~decided[earlier]]] = True
        decided |= ~waits
        gone = later[decided[earlier] & stays[earlier]]
        stays[gone], decided[gone] = False, True
        open_pairs = ~decided[later]
        later, earlier = later[open_pairs], earlier[open_pairs]
        rest = stays[earlier] | ~decided[earlier]
        later, earlier = later[rest], earlier[rest]
    return stays


def _has_close(points: Floats, others: Floats, distance: float) -> NDArray[np.bool_]:
    found = np.zeros(len(points), dtype=bool)
    found[_close_pairs(points, others, distance)[0]] = True
    return found


def _close_pairs(points: Floats, others: Floats, distance: float) -> tuple[Integers, Integers]:
    """(indices of points, indices of others) of all pairs closer than the distance."""
    if len(points) == 0 or len(others) == 0:
        return np.empty(0, np.int64), np.empty(0, np.int64)
    low = np.minimum(points.min(axis=0), others.min(axis=0))
    cells, other_cells = (np.floor((p - low) / distance).astype(np.int64) + 1 for p in (points, others))
    sides = np.maximum(cells.max(axis=0), other_cells.max(axis=0)) + 2
    factor = np.array([sides[1] * sides[2], sides[2], 1])
    key = other_cells @ factor
    order = np.argsort(key, kind="stable")
    key = key[order]
    ones, twos = [], []
    for dx in (-1, 0, 1):
        for dy in (-1, 0, 1):
            # The three cells along z follow each other.
            middle = (cells + np.array([dx, dy, 0])) @ factor
            begin = np.searchsorted(key, middle - 1, side="left")
            entry, offset = expand(np.searchsorted(key, middle + 1, side="right") - begin)
            other = order[begin[entry] + offset]
            near = ((points[entry] - others[other]) ** 2).sum(axis=1) < distance**2
            ones.append(entry[near])
            twos.append(other[near])
    return np.concatenate(ones), np.concatenate(twos)
