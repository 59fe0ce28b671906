# SPDX-License-Identifier: GPL-3.0-or-later
"""The merged error is the film's: the same sums give the same numbers as the engine's report."""

import numpy as np
import pytest
from numpy.typing import NDArray

from addon.scene import description as d
from engine.farm import error
from tests.engine.library import Render, Scene
from tests.render.build import Builder, camera, grey

WIDTH, HEIGHT = 24, 16
SETTINGS = {"seed": 3, "threads": 1}


def samples_of(scene: Scene, count: int) -> NDArray[np.float64]:
    """(samples, height, width, 3): each is what the picture's sum grows by when it has one more."""
    sums: list[NDArray[np.float64]] = [np.zeros((HEIGHT, WIDTH, 3))]
    for n in range(1, count + 1):
        with Render(scene, samples=n, **SETTINGS) as render:
            sums.append(n * render.run().read().astype(np.float64))
    return np.diff(np.stack(sums), axis=0)


@pytest.mark.parametrize(("samples", "look"), [(4, 1), (8, 2), (13, 3)])
def test_it_is_the_reports(samples: int, look: int) -> None:
    builder = Builder(camera((0, -6, 0), (0, 0, 0), 60), WIDTH, HEIGHT)
    builder.sphere((0, 0, -2), 1.5, d.Lambert(grey(0.6))).sphere((0, 0, 4), 1.0, d.Light(grey(5)))
    scene = Scene(builder.done())
    with Render(scene, samples=samples, **SETTINGS) as render:
        told = render.run().report()["error"]
    found_samples, sums, counts = samples_of(scene, samples), np.zeros((8, HEIGHT, WIDTH, 3)), np.zeros(8)
    for i, sample in enumerate(found_samples):
        sums[i % 8] += sample
        counts[i % 8] += 1
    found = error.estimate(sums, counts, look).report()
    assert found is not None
    for name in ("relmse", "low", "high"):
        assert found[name] == (None if told[name] is None else pytest.approx(told[name], rel=1e-4)), name
    share = pytest.approx(told["tails"]["largest_share"], rel=1e-4)
    assert found["tails"] == {**told["tails"], "largest_share": share}


def test_blocks_change_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    sums = np.random.default_rng(1).gamma(0.3, size=(8, 9, 11, 3))
    whole = error.estimate(sums, np.full(8, 2.0), 1)
    monkeypatch.setattr(error, "_BLOCK_PIXELS", 17)
    parts = error.estimate(sums, np.full(8, 2.0), 1)
    assert (parts.x, parts.y) == (whole.x, whole.y)
    assert (parts.relmse, parts.low, parts.high) == pytest.approx((whole.relmse, whole.low, whole.high), rel=1e-12)


def test_nothing_is_known_of_one_range_and_of_a_black_picture() -> None:
    one = np.zeros((8, 2, 2, 3))
    one[0] = 1
    assert error.estimate(one, np.eye(8)[0], 1).report() is None
    assert error.estimate(np.zeros((8, 2, 2, 3)), np.ones(8), 1).report() is None
