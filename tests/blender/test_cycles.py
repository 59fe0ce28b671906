# SPDX-License-Identifier: GPL-3.0-or-later
"""Cycles and Glimmer in one process: neither disturbs the other, and both show the same light.

Means of blocks of the picture over a few seeds are compared by Welch's t-test, at one level over all blocks of all
scenes of a host. The seeds are fixed: the same host gives the same verdict.
"""

from pathlib import Path

import numpy as np
import pytest
from hosts import Host
from numpy.typing import NDArray
from scipy import stats

LEVEL = 1e-3  # of a false alarm in the whole module on a host
BLOCKS = (2, 3)  # down and across
# Both sum hundreds of float32 values a pixel in another order; where nothing else is random this is left.
ROUNDING = 2e-6


@pytest.fixture(scope="module")
def pictures(host: Host, tmp_path_factory: pytest.TempPathFactory) -> dict[str, NDArray[np.float32]]:
    folder = tmp_path_factory.mktemp("cycles")
    host.run_script(Path(__file__).with_name("cycles_script.py"), str(folder), timeout=290)
    return dict(np.load(folder / "pictures.npz"))


def block_means(images: NDArray[np.float32]) -> NDArray[np.float64]:
    """(seeds, blocks, 3)"""
    seeds, height, width, _ = images.shape
    rows, columns = BLOCKS
    cut = images.astype(np.float64).reshape(seeds, rows, height // rows, columns, width // columns, 3)
    return cut.mean(axis=(2, 4)).reshape(seeds, -1, 3)


def test_both_engines_show_the_same_light(pictures: dict[str, NDArray[np.float32]]) -> None:
    names = sorted({key.rsplit(".", 1)[0] for key in pictures})
    assert len(names) >= 15
    tests = len(names) * BLOCKS[0] * BLOCKS[1] * 3
    failures = []
    for name in names:
        cycles, ours = (block_means(pictures[f"{name}.{engine}"]) for engine in ("CYCLES", "GLIMMER"))
        assert cycles.mean() > 0.01, f"{name} is black in Cycles: it would test nothing"
        difference = ours.mean(axis=0) - cycles.mean(axis=0)
        count = len(ours)
        variances = np.stack([ours.var(axis=0, ddof=1), cycles.var(axis=0, ddof=1)]) / count
        error = np.sqrt(variances.sum(axis=0) + (ROUNDING * cycles.mean(axis=0)) ** 2)
        freedom = variances.sum(axis=0) ** 2 / np.maximum((variances**2).sum(axis=0) / (count - 1), 1e-300)
        p = 2.0 * stats.t.sf(np.abs(difference) / np.maximum(error, 1e-300), np.maximum(freedom, count - 1))
        if p.min() < LEVEL / tests:
            ratio = float(ours.mean() / cycles.mean())
            failures.append(f"{name}: p = {p.min():.2g} in its worst block, mean ratio {ratio:.5f}")
    assert not failures, "\n".join(failures)
