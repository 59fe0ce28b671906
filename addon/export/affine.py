# SPDX-License-Identifier: GPL-3.0-or-later
"""Matrices of places, by hand: LAPACK's last bits depend on where arrays lie in memory, and a picture must not."""

from __future__ import annotations

import numpy as np

from ..scene.description import Floats


def inverse(matrix: Floats) -> Floats:
    """(4, 4) of an affine one, float64. All 0 where it leaves no volume."""
    columns = np.asarray(matrix, np.float64)[:3, :3].T
    rows = np.array([np.cross(columns[(i + 1) % 3], columns[(i + 2) % 3]) for i in range(3)])
    determinant = float((columns[0] * rows[0]).sum())
    result = np.zeros((4, 4))
    if determinant != 0.0:
        result[:3, :3] = rows / determinant
        result[:3, 3] = -(result[:3, :3] * matrix[:3, 3]).sum(axis=1)
        result[3, 3] = 1.0
    return result
