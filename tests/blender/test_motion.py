# SPDX-License-Identifier: GPL-3.0-or-later
"""Motion blur from Blender: what moves is asked for at the moments that Cycles asks for it, and looks as in Cycles."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hosts import Host
from numpy.typing import NDArray
from scipy import stats

SCRIPT = Path(__file__).with_name("motion_script.py")
LEVEL = 1e-3  # of a false alarm in all pictures of a host
BLOCKS = (3, 4)
ROUNDING = 2e-6


@pytest.fixture(scope="module")
def folder(host: Host, tmp_path_factory: pytest.TempPathFactory) -> Path:
    result = tmp_path_factory.mktemp("motion")
    host.run_script(SCRIPT, str(result), "scene")
    return result


def interval(position: str) -> tuple[float, float]:
    opens = {"START": 1.0, "CENTER": 0.5, "END": 0.0}[position]
    return opens, opens + 1.0


def motions(scene: dict[str, Any]) -> list[NDArray[np.float64]]:
    return [np.array(item["motion"]) for item in scene["objects"] if "motion" in item]


@pytest.mark.parametrize("position", ["START", "CENTER", "END"])
def test_moments(folder: Path, position: str) -> None:
    scene = json.loads((folder / f"{position}.json").read_text())
    opens, closes = interval(position)
    slide, turn, fine, sphere, instance = motions(scene)
    moments = np.linspace(opens, closes, 3)
    np.testing.assert_allclose(slide[:, 0, 3], np.interp(moments, [0, 1, 2], [0, 0, 4]), atol=1e-5)
    np.testing.assert_allclose(slide[:, 1, 3], np.interp(moments, [0, 1, 2], [0, 2, 2]), atol=1e-5)
    angles = np.arctan2(turn[:, 1, 0], turn[:, 0, 0])
    np.testing.assert_allclose(np.unwrap(angles), np.linspace(opens, closes, len(turn)) * np.pi / 2, atol=1e-4)
    np.testing.assert_allclose(fine[:, 0, 3], 2.0 * np.linspace(opens, closes, 5), atol=1e-5)
    np.testing.assert_allclose(sphere[:, 0, 3], moments, atol=1e-5)
    camera = np.array(scene["camera"]["motion"])
    np.testing.assert_allclose(camera[:, 0, 3], moments, atol=1e-5)
    np.testing.assert_allclose(instance[:, :3, 3], np.stack([moments, 0 * moments, 0 * moments + 4], axis=1), atol=1e-5)


def test_without_motion_blur_nothing_moves(folder: Path) -> None:
    scene = json.loads((folder / "still.json").read_text())
    assert not motions(scene) and "motion" not in scene["camera"]


def test_the_scene_is_left_where_it_was(folder: Path) -> None:
    for state in json.loads((folder / "state.json").read_text()).values():
        assert state["frame"] == 1.0 and np.allclose(state["place"], [0.0, 2.0, 1.0])


def test_what_stands_still_is_told(folder: Path) -> None:
    notices = json.loads((folder / "state.json").read_text())["CENTER"]["notices"]
    for name, words in (
        ("Shining", "shines and moves"),
        ("POINT", "a lamp that moves"),
        ("Vanishing", "appears or vanishes"),
        ("Bent", "may change its shape"),
        ("Sphere", "rendered as the mesh that it is"),
    ):
        assert sum(name in line and words in line for line in notices) == 1, (name, notices)


def block_means(images: NDArray[np.float32]) -> NDArray[np.float64]:
    """(seeds, blocks, 3)"""
    seeds, height, width, _ = images.shape
    rows, columns = BLOCKS
    cut = images.astype(np.float64).reshape(seeds, rows, height // rows, columns, width // columns, 3)
    return cut.mean(axis=(2, 4)).reshape(seeds, -1, 3)


def test_it_looks_as_in_cycles(host: Host, tmp_path: Path) -> None:
    """By Welch's test, at one level over all blocks of all pictures."""
    host.run_script(SCRIPT, str(tmp_path), "pictures", timeout=290)
    pictures = dict(np.load(tmp_path / "pictures.npz"))
    names = sorted({key.rsplit(".", 1)[0] for key in pictures})
    failures = []
    for name in names:
        cycles, ours = (block_means(pictures[f"{name}.{engine}"]) for engine in ("CYCLES", "GLIMMER"))
        count = len(ours)
        variances = np.stack([ours.var(axis=0, ddof=1), cycles.var(axis=0, ddof=1)]) / count
        error = np.sqrt(variances.sum(axis=0) + (ROUNDING * cycles.mean(axis=0)) ** 2)
        freedom = variances.sum(axis=0) ** 2 / np.maximum((variances**2).sum(axis=0) / (count - 1), 1e-300)
        t = np.abs(ours.mean(axis=0) - cycles.mean(axis=0)) / np.maximum(error, 1e-300)
        p = 2.0 * stats.t.sf(t, np.maximum(freedom, count - 1))
        if p.min() < LEVEL / (len(names) * p.size):
            ratio = float(ours.mean() / cycles.mean())
            failures.append(f"{name}: p = {p.min():.2g} in its worst block, mean ratio {ratio:.5f}")
    assert not failures, "\n".join(failures)
