# SPDX-License-Identifier: GPL-3.0-or-later
"""Panoramic cameras and stereo pairs from Blender, pixel by pixel against Cycles: what is seen where, without noise."""

from pathlib import Path

import numpy as np
import pytest
from hosts import OLDEST_AND_NEWEST, Host
from numpy.typing import NDArray
from test_render import channels

pytestmark = OLDEST_AND_NEWEST

SCRIPT = Path(__file__).with_name("panorama_script.py")
KINDS = 8 + 12
# Rays differ by a hundredth of a pixel, the filter's width.
SLOPE = 2e-3


@pytest.fixture(scope="module")
def pictures(host: Host, tmp_path_factory: pytest.TempPathFactory) -> dict[str, NDArray[np.float32]]:
    folder = tmp_path_factory.mktemp("panoramas")
    host.run_script(SCRIPT, str(folder))
    found = dict(np.load(folder / "pictures.npz"))
    for path in folder.glob("*_[LR].exr"):
        name, engine = path.stem[:-2].rsplit(".", 1)
        parts = channels(path)
        found[f"{name}, {path.stem[-1]}.{engine}"] = np.stack([parts[c] for c in "RGB"], axis=-1)
    return found


def test_every_pixel_is_that_of_cycles(pictures: dict[str, NDArray[np.float32]]) -> None:
    names = sorted({key.rsplit(".", 1)[0] for key in pictures})
    assert len(names) >= KINDS
    failures = []
    for name in names:
        cycles, ours = pictures[f"{name}.CYCLES"], pictures[f"{name}.GLIMMER"]
        apart = np.abs(ours - cycles).max(axis=-1)
        allowed = SLOPE * (1.0 + np.abs(cycles).max(axis=-1))
        # At the edge of a body or a circle one of the samples may be on the other side.
        if (apart > allowed).mean() > 5e-3 or np.median(apart) > 1e-4:
            failures.append(f"{name}: {(apart > allowed).sum()} pixels of {apart.size}, up to {apart.max():.3g}")
        assert cycles.std() > 0.05
    assert not failures, "\n".join(failures)


def test_eyes_see_apart(pictures: dict[str, NDArray[np.float32]]) -> None:
    for name in {key.partition(", L.")[0] for key in pictures if ", L." in key}:
        left, right = pictures[f"{name}, L.GLIMMER"], pictures[f"{name}, R.GLIMMER"]
        assert np.abs(left - right).max() > 0.1, name


def test_outside_a_fisheyes_circle_it_is_black(pictures: dict[str, NDArray[np.float32]]) -> None:
    for name in ("equidistant", "equisolid", "mirror ball"):
        assert not pictures[f"{name}.GLIMMER"][0, 0].any()
        assert pictures[f"{name}.GLIMMER"][20, 30].all()
