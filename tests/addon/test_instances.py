# SPDX-License-Identifier: GPL-3.0-or-later
"""What millions of instances are made of in bulk, against what one is made of."""

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from addon.export.instance import dimensions_left, hash_pair, hash_pairs


def test_hashes_in_bulk_are_the_single_ones() -> None:
    index = np.array([0, 1, 2, 77, 16383, 16384, 20000, 2**31])
    for own in (0, 5, 0xFFFFFFFF):
        assert hash_pairs(own, index).tolist() == [hash_pair(own, int(i)) for i in index]


def test_scales_of_zero_are_counted() -> None:
    rng = np.random.default_rng(0)
    matrices = np.tile(np.eye(4), (20000, 1, 1))
    matrices[:, :3, :3] = rng.normal(size=(20000, 3, 3)) * 10.0 ** rng.uniform(-5, 5, (20000, 1, 1))
    matrices[7, :3, 1] = 0.0
    matrices[19999, :3, 0] = matrices[19999, :3, 1] = 0.0
    expected = np.full(20000, 3)
    expected[[7, 19999]] = 2, 1
    assert np.array_equal(dimensions_left(matrices), expected)
