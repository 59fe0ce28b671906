# SPDX-License-Identifier: GPL-3.0-or-later
"""Cycles and Glimmer in one process: neither disturbs the other, and both show the same light.

Means of blocks of the picture over a few seeds are compared by Welch's t-test, at one level over all blocks of all
scenes of a host. The seeds are fixed: the same host gives the same verdict.
"""

from pathlib import Path

import numpy as np
import pytest
from hosts import OLDEST_AND_NEWEST, Host
from numpy.typing import NDArray
from scipy import stats

pytestmark = OLDEST_AND_NEWEST

LEVEL = 1e-3  # of a false alarm in the whole module on a host
BLOCKS = (2, 3)  # down and across
# Both sum hundreds of float32 values a pixel in another order; where nothing else is random this is left.
ROUNDING = 2e-6
HAIR = 0.02  # of a block's light, by which tubes may differ from Cycles' curves


@pytest.fixture(scope="module")
def folder(host: Host, tmp_path_factory: pytest.TempPathFactory) -> Path:
    result = tmp_path_factory.mktemp("cycles")
    host.run_script(Path(__file__).with_name("cycles_script.py"), str(result), timeout=290)
    return result


@pytest.fixture(scope="module")
def pictures(folder: Path) -> dict[str, NDArray[np.float32]]:
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


def test_strands_of_hair_are_as_long_as_thick_and_as_bright_as_in_cycles(folder: Path) -> None:
    """Tubes of six sides stand for ribbons with a round normal: nearly the same light, not the same."""
    arrays = np.load(folder / "hair.npz")
    cycles, ours = (block_means(arrays[engine]).mean(axis=0) for engine in ("CYCLES", "GLIMMER"))
    np.testing.assert_allclose(ours, cycles, rtol=HAIR)


def blackman_harris_cdf(x: NDArray[np.float64]) -> NDArray[np.float64]:
    """Of the window over [0, 1]."""
    t = np.clip(x, 0.0, 1.0)
    waves = ((1, -0.48829), (2, 0.14128), (3, -0.01168))
    terms = [factor * np.sin(2.0 * np.pi * n * t) / (2.0 * np.pi * n) for n, factor in waves]
    return t + np.sum(terms, axis=0) / 0.35875


# Cycles draws from a table of 1024 places of the filter, the last of which is left at 0 (util_cdf_invert): off by a
# step of it where the filter is densest, and a step of the samples elsewhere.
CYCLES_TABLE = (1.0 / 0.35875 + 1.0) / 1023
# The engine's has 4096 equal parts of the filter's integral, and the outermost are spread evenly over the long tails.
GLIMMER_TABLE = 1.0 / 4096


@pytest.mark.parametrize("filter_width", [1.5, 2.5])
@pytest.mark.parametrize(("engine", "table"), [("CYCLES", CYCLES_TABLE), ("GLIMMER", GLIMMER_TABLE)])
def test_both_engines_spread_an_edge_alike(folder: Path, engine: str, table: float, filter_width: float) -> None:
    """The edge's spread is the filter's CDF: both are held against it, by columns, each row an estimate of its own."""
    rows = np.load(folder / "edges.npz")[f"{filter_width}.{engine}"][..., 0].astype(np.float64)
    columns = np.arange(rows.shape[1]) + 0.5 - rows.shape[1] / 2
    expected = blackman_harris_cdf((0.3 - columns) / (2.0 * filter_width) + 0.5)
    error = rows.std(axis=0, ddof=1) / np.sqrt(len(rows))
    assert (error > 0.0).sum() >= 2, "no column is partly lit"
    allowed = stats.t.isf(LEVEL / (2 * 2 * 2 * len(columns)), len(rows) - 1) * error + table + 1e-6
    excess = np.abs(rows.mean(axis=0) - expected) - allowed
    worst = int(excess.argmax())
    assert excess[worst] <= 0.0, (columns[worst], rows.mean(axis=0)[worst], expected[worst], allowed[worst])
