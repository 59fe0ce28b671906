# SPDX-License-Identifier: GPL-3.0-or-later
"""What a field stands on in place of a plane: a height image, or the upper side of a mesh. Plain numpy."""

import dataclasses
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from .noise import Floats, Integers, Sloped

_PAIRS = 1 << 20  # of places and triangles that are tried at once


class Ground(Protocol):
    def at(self, x: Floats, y: Floats) -> tuple[NDArray[np.bool_], Sloped]:
        """Of places x, y, each (n): whether there is ground, and its height and slopes, 0 where there is none."""
        ...


@dataclasses.dataclass(frozen=True)
class HeightImage:
    """pixels: (rows, columns), the lowest row first, over the square of `size` around the origin; height is that of a
    pixel of 1. Between the middles of pixels heights go straight; beyond the image its edge goes on."""

    pixels: Floats
    size: float
    height: float

    def at(self, x: Floats, y: Floats) -> tuple[NDArray[np.bool_], Sloped]:
        rows, columns = self.pixels.shape
        column, j, inside_x = _between(x / self.size + 0.5, columns)
        row, i, inside_y = _between(y / self.size + 0.5, rows)
        right, above = np.minimum(j + 1, columns - 1), np.minimum(i + 1, rows - 1)
        a, b = self.pixels[i, j], self.pixels[i, right]
        c, d = self.pixels[above, j], self.pixels[above, right]
        low, high = a + column * (b - a), c + column * (d - c)
        z = self.height * (low + row * (high - low))
        across = (b - a) + row * ((d - c) - (b - a))
        slope_x = np.where(inside_x, self.height * columns / self.size * across, 0.0)
        slope_y = np.where(inside_y, self.height * rows / self.size * (high - low), 0.0)
        return np.ones(len(x), dtype=bool), (z, slope_x, slope_y)


def _between(share: Floats, count: int) -> tuple[Floats, Integers, NDArray[np.bool_]]:
    """How far from the middle of a pixel to the next, that pixel's number, and whether it has a next."""
    place = share * count - 0.5
    held = np.clip(place, 0.0, count - 1.0)
    first = np.minimum(held.astype(np.int64), max(count - 2, 0))
    return held - first, first, (place > 0.0) & (place < count - 1.0)


@dataclasses.dataclass(frozen=True)
class MeshGround:
    """triangles: (t, 3, 3), corners in the field's own space."""

    triangles: Floats

    def at(self, x: Floats, y: Floats) -> tuple[NDArray[np.bool_], Sloped]:
        """The highest surface above or below each place. Places are sorted into a lattice of about one triangle a
        cell, and tried with the triangles of theirs."""
        found, z = np.zeros(len(x), dtype=bool), np.full(len(x), -np.inf)
        slope_x, slope_y = np.zeros(len(x)), np.zeros(len(x))
        normal = np.cross(self.triangles[:, 1] - self.triangles[:, 0], self.triangles[:, 2] - self.triangles[:, 0])
        size = np.abs(self.triangles).max(initial=0.0)
        flat = np.abs(normal[:, 2]) > 1e-12 * size * size  # the rest stand upright, and nothing stands on them
        triangles, normal = self.triangles[flat], normal[flat]
        if len(triangles) == 0 or len(x) == 0:
            return found, (np.zeros(len(x)), slope_x, slope_y)
        for pair_places, pair_triangles in _near(x, y, triangles):
            corner = triangles[pair_triangles]
            px, py = x[pair_places], y[pair_places]
            inside = np.ones(len(px), dtype=bool)
            up = np.sign(normal[pair_triangles, 2])
            for k in range(3):
                a, b = corner[:, k], corner[:, (k + 1) % 3]
                side = (b[:, 0] - a[:, 0]) * (py - a[:, 1]) - (b[:, 1] - a[:, 1]) * (px - a[:, 0])
                inside &= side * up >= -1e-9 * size * size
            places, which = pair_places[inside], pair_triangles[inside]
            n, a = normal[which], triangles[which, 0]
            own_x, own_y = -n[:, 0] / n[:, 2], -n[:, 1] / n[:, 2]
            height = a[:, 2] + own_x * (x[places] - a[:, 0]) + own_y * (y[places] - a[:, 1])
            order = np.argsort(height, kind="stable")  # of several at one place the last is kept, which is the highest
            order = order[height[order] > z[places[order]]]
            at = places[order]
            z[at], slope_x[at], slope_y[at], found[at] = height[order], own_x[order], own_y[order], True
        return found, (np.where(found, z, 0.0), slope_x, slope_y)


def _near(x: Floats, y: Floats, triangles: Floats) -> list[tuple[Integers, Integers]]:
    """Pairs (places, triangles), by the lattice's cells that a triangle's bounds touch."""
    low, high = triangles[:, :, :2].min(axis=1), triangles[:, :, :2].max(axis=1)
    origin, extent = low.min(axis=0), np.maximum(np.ptp(np.concatenate([low, high]), axis=0), 1e-12)
    cells = int(np.clip(np.sqrt(len(triangles)), 1, 1024))
    step = extent / cells

    def cell_of(place: Floats, axis: int) -> Integers:
        return np.clip(np.floor((place - origin[axis]) / step[axis]).astype(np.int64), 0, cells - 1)

    within = (x >= origin[0]) & (x <= origin[0] + extent[0]) & (y >= origin[1]) & (y <= origin[1] + extent[1])
    places = np.flatnonzero(within)
    key = cell_of(x[places], 0) * cells + cell_of(y[places], 1)
    places = places[np.argsort(key, kind="stable")]
    starts = np.searchsorted(np.sort(key), np.arange(cells * cells + 1))
    # Each triangle's cells, one row of the lattice after another.
    i0, i1, j0, j1 = (cell_of(bound[:, axis], axis) for axis in (0, 1) for bound in (low, high))
    triangle, offset = expand((i1 - i0 + 1) * (j1 - j0 + 1))
    columns = (j1 - j0 + 1)[triangle]
    cell = (i0[triangle] + offset // columns) * cells + j0[triangle] + offset % columns
    count = starts[cell + 1] - starts[cell]
    cell, triangle, count = cell[count > 0], triangle[count > 0], count[count > 0]
    if len(count) == 0:
        return []
    groups = []
    total = np.cumsum(count)
    for part in np.split(np.arange(len(cell)), np.searchsorted(total, np.arange(_PAIRS, total[-1], _PAIRS))):
        entry, offset = expand(count[part])
        groups.append((places[starts[cell[part][entry]] + offset], triangle[part][entry]))
    return groups


def expand(count: Integers) -> tuple[Integers, Integers]:
    """For entries that stand for `count` items each: the entry of every item, and its number among that entry's."""
    entry = np.repeat(np.arange(len(count)), count)
    return entry, np.arange(len(entry)) - np.repeat(np.cumsum(count) - count, count)
