# SPDX-License-Identifier: GPL-3.0-or-later
"""Voxels of volume objects, read by the openvdb module where the host carries it: Blender itself does not hand them
out."""

from __future__ import annotations

import importlib
import tempfile
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..scene.description import Floats, Mesh
from ..scene.program import Op, Texture
from .translate.values import Triple, math, op

if TYPE_CHECKING:
    import bpy

# The engine's bounds: columns, and rows of all slices together.
MOST_COLUMNS, MOST_ROWS = 65536, 65536
NO_READER = "this Blender carries no openvdb module, which reads them"


class NoGridsError(Exception):
    """Why a volume's voxels cannot be had."""


@dataclass(frozen=True, eq=False)
class Grid:
    values: NDArray[np.float32]  # (x, y, z, channels)
    to_index: Floats  # (4, 4), from the object's space; the first voxel is (0, 0, 0)
    name: str = ""

    def box(self) -> Floats:
        """(8, 3): the corners, in the object's space, of all that is not 0."""
        high = np.array(self.values.shape[:3], np.float64)
        corners = np.array([[(-1.0, high[k])[i >> k & 1] for k in range(3)] + [1.0] for i in range(8)])
        found: Floats = (corners @ np.linalg.inv(self.to_index).T)[:, :3]
        return found

    def lookup(self, place: Triple) -> Op:
        """A vector, of a place in the object's space."""
        nx, ny, nz = (float(n) for n in self.values.shape[:3])
        rows = self.to_index.tolist()
        index = op("combine", *(math("add", op("dot", tuple(row[:3]), place), row[3]) for row in rows[:3]))
        return op("grid", index, (nx, ny, nz), modes=("linear",), resource=self.texture)

    @cached_property
    def texture(self) -> Texture:
        """Slices below each other, as the engine has them."""
        nx, ny, nz, channels = self.values.shape
        pixels = np.ascontiguousarray(self.values.transpose(2, 1, 0, 3))
        return Texture(self.name, pixels.reshape(nz * ny, nx, channels))


def openvdb() -> Any:
    """The module; None where there is none."""
    import bpy

    expose = getattr(bpy.utils, "expose_bundled_modules", None)
    if expose is not None:
        expose()
    for name in ("openvdb", "pyopenvdb"):
        try:
            return importlib.import_module(name)
        except ImportError:
            continue
    return None


def read_grids(volume: bpy.types.Volume) -> dict[str, Grid]:
    """By name; level sets and what is empty are left out. Raises NoGridsError."""
    vdb = openvdb()
    if vdb is None:
        raise NoGridsError(NO_READER)
    if not volume.grids.load():
        raise NoGridsError(volume.grids.error_message or "its file cannot be read")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "grids.vdb"
        if not volume.grids.save(filepath=str(path)):
            raise NoGridsError("its grids cannot be saved to be read")
        try:
            grids, _ = vdb.readAll(str(path))
        except (OSError, RuntimeError, TypeError, ValueError) as error:
            raise NoGridsError(f"its grids cannot be read: {error}") from error
        found = {grid.name: _read(grid) for grid in grids}
    return {name: grid for name, grid in found.items() if grid is not None}


def _read(grid: Any) -> Grid | None:
    if grid.empty() or not hasattr(grid, "copyToArray"):
        return None
    low, high = (np.array(corner) for corner in grid.evalActiveVoxelBoundingBox())
    shape = tuple(int(n) for n in high - low + 1)
    channels = 3 if isinstance(grid.background, tuple) else 1
    values = np.zeros(shape + ((3,) if channels == 3 else ()), np.float32)
    grid.copyToArray(values, ijk=tuple(int(n) for n in low))
    values = np.nan_to_num(values.reshape(*shape, channels))
    to_object = np.eye(4)
    origin = np.array(grid.transform.indexToWorld((0, 0, 0)))
    for axis in range(3):
        step = [float(axis == k) for k in range(3)]
        to_object[:3, axis] = np.array(grid.transform.indexToWorld(tuple(step))) - origin
    to_object[:3, 3] = np.array(grid.transform.indexToWorld(tuple(float(n) for n in low)))
    return _within_bounds(Grid(values, np.linalg.inv(to_object), grid.name))


def _within_bounds(grid: Grid) -> Grid:
    """Means of 2 x 2 x 2 voxels in place of so many that the engine cannot hold them."""
    values, to_index = grid.values, grid.to_index
    while values.shape[0] > MOST_COLUMNS or values.shape[1] * values.shape[2] > MOST_ROWS:
        values = np.pad(values, [(0, n % 2) for n in values.shape[:3]] + [(0, 0)])
        x, y, z, channels = values.shape
        values = values.reshape(x // 2, 2, y // 2, 2, z // 2, 2, channels).mean(axis=(1, 3, 5))
        half = np.diag([0.5, 0.5, 0.5, 1.0])
        half[:3, 3] = -0.25  # the middle of the first eight is their mean's place
        to_index = half @ to_index
    return Grid(np.ascontiguousarray(values, np.float32), to_index, grid.name)


def box_of(grids: dict[str, Grid], name: str) -> Mesh:
    """A closed box about all of them, normals outward."""
    corners = np.concatenate([grid.box() for grid in grids.values()])
    low, high = corners.min(axis=0), corners.max(axis=0)
    vertices = np.array([[(low, high)[i >> k & 1][k] for k in range(3)] for i in range(8)])
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    triangles = [t for f in faces for t in ((f[0], f[1], f[2]), (f[0], f[2], f[3]))]
    return Mesh(name, vertices, np.array(triangles, np.uint32))
