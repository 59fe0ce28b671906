# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers at the end of float32. Embree ends the whole process, Blender with it, on a ray that is not valid."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.engine import scenes
from tests.engine.scenes import QUAD, changed, run_glimmer, scene, write_scene

pytestmark = pytest.mark.usefixtures("glimmer_command")

WHITE = scene(
    materials={"grey": {"type": "lambert", "albedo": 0.5}},
    meshes={"quad": QUAD},
    objects=[{"mesh": "quad", "material": "grey"}],
    environment={"radiance": 1},
)


def standing(thickness: float) -> list[list[float]]:
    """A quad in front of the camera, its normal scaled by `thickness`."""
    return [[1, 0, 0, 0], [0, 0, thickness, -2], [0, 1, 0, 0], [0, 0, 0, 1]]


@pytest.mark.parametrize("exponent", [-6, -11, -18, -25, -39, -60, 10, 17, 19, 39, 60])
def test_scale_of_one_axis(exponent: int, tmp_path: Path) -> None:
    """The same picture as at scale 1, or left out with a warning where float32 cannot hold the inverse; no crash."""
    expected = scenes.render(tmp_path, changed(WHITE, ("objects", 0, "to_world"), standing(1)), "--spp", 4).rgb
    path = write_scene(tmp_path, changed(WHITE, ("objects", 0, "to_world"), standing(10.0**exponent)))
    done = run_glimmer(path, "-o", tmp_path / "scaled.exr", "--spp", 4)
    assert done.returncode == 0, done.stderr
    left_out = "1 instance(s) of zero scale, or nearly, were left out" in done.stderr
    picture = scenes.read_exr(tmp_path / "scaled.exr").rgb
    assert expected.min() < 0.7
    assert np.allclose(picture, 1 if left_out else expected, rtol=1e-5, atol=0)
    assert left_out == (not -12 < exponent < 38)


@pytest.mark.parametrize("integrator", ["path", "baseline"])
@pytest.mark.parametrize(
    ("key", "value"),
    [
        (("camera", "shift"), [1e300, 0]),
        (("camera", "clip"), [1e35, None]),
        (("lights",), [{"type": "point", "position": [0, 0, 1e300], "intensity": 1}]),
        (("lights",), [{"type": "spot", "position": [0, 0, 1e25], "direction": [0, 0, -1], "intensity": 1}]),
        (("objects", 0, "to_world"), [[1, 0, 0, 0], [0, 1, 0, 1e35], [0, 0, 1, 0], [0, 0, 0, 1]]),
    ],
)
def test_far_beyond(key: tuple[str | int, ...], value: Any, integrator: str, tmp_path: Path) -> None:
    path = write_scene(tmp_path, changed(WHITE, key, value))
    done = run_glimmer(path, "-o", tmp_path / "out.exr", "--spp", 2, "--integrator", integrator)
    assert done.returncode in (0, 1), done.stderr
    assert "Assertion" not in done.stderr


@pytest.mark.parametrize("integrator", ["path", "baseline"])
def test_a_few_spheres_alone(integrator: str, tmp_path: Path) -> None:
    """Up to eight are tried one by one, more stand in a BVH: the same bits."""
    materials = {
        "grey": {"type": "lambert", "albedo": 0.5},
        "glass": {"type": "glass", "ior": 1.5},
        "moon": {"type": "light", "radiance": [3, 2, 1]},
    }
    spheres: list[dict[str, Any]] = [
        {"center": [1.1 * (i % 4) - 1.6, 0.4 * i, 1.6 * (i // 4) - 0.8], "radius": 0.6, "material": material}
        for i, material in enumerate(("moon", "grey", "glass", "grey", "grey", "glass", "grey", "grey"))
    ]
    far = {"center": [0, -1e5, 0], "radius": 1e-3, "material": "grey"}
    content = scene(
        film={"width": 24, "height": 16}, materials=materials, spheres=spheres, environment={"radiance": 0.3}
    )
    pictures = []
    for name, more in (("few", []), ("many", [far])):
        settings = ("--spp", 16, "--integrator", integrator, "--report", tmp_path / f"{name}.json")
        pictures.append(scenes.render(tmp_path, {**content, "spheres": spheres + more}, *settings).rgb)
        said = json.loads((tmp_path / f"{name}.json").read_text())["left_out"]
        assert ("a few spheres alone: no BVH" in said) == (name == "few")
    assert np.unique(pictures[0]).size > 40 and np.array_equal(pictures[0], pictures[1])
