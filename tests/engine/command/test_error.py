# SPDX-License-Identifier: GPL-3.0-or-later
"""What the command says of the error: heavy tails and their evidence, the rate, and the time that is left."""

import json
from pathlib import Path

import pytest

from tests.engine.scenes import QUAD, Scene, hazy_moon, run_glimmer, scene, write_scene

pytestmark = pytest.mark.usefixtures("glimmer_command")


def caustic() -> Scene:
    """A mirror ball throws a small moon's light onto a grey floor: found by chance alone."""
    return scene(
        film={"width": 16, "height": 12},
        materials={
            "grey": {"type": "lambert", "albedo": 0.6},
            "mirror": {"type": "mirror", "reflectance": 0.95},
            "moon": {"type": "light", "radiance": 300},
        },
        meshes={"quad": QUAD},
        objects=[
            {
                "mesh": "quad",
                "material": "grey",
                "to_world": [[4, 0, 0, 0], [0, 4, 0, 0], [0, 0, 4, -1.5], [0, 0, 0, 1]],
            }
        ],
        spheres=[
            {"center": [0, 0, 0], "radius": 1, "material": "mirror"},
            {"center": [3, -2, 3], "radius": 0.2, "material": "moon"},
        ],
    )


@pytest.mark.parametrize("limit", [("--spp", "64"), ("--spp", "64", "--time", "60")])
def test_heavy_tails_are_named_and_do_not_stop(tmp_path: Path, limit: tuple[str, ...]) -> None:
    """The interval is below the target at once, and the render goes on all the same."""
    path = write_scene(tmp_path, caustic())
    report_file = tmp_path / "r.json"
    done = run_glimmer(path, "-o", tmp_path / "out.exr", "--error", "1e9", *limit, "--report", report_file)
    assert done.returncode == 0, done.stderr
    report = json.loads(report_file.read_text())
    tails = report["error"]["tails"]
    assert report["spp"] == 64 and report["seconds_to_target"] is None
    assert not tails["certifiable"] and tails["largest_share"] > tails["allowed"] == 0.1
    assert 0 <= tails["x"] < 16 and 0 <= tails["y"] < 12
    evidence = f"{100 * tails['largest_share']:.0f} % of the error in one pixel of one replicate"
    last = done.stderr.splitlines()[-1]
    assert "not certifiable: heavy tails" in last and evidence in last and f"({tails['x']}, {tails['y']})" in last


def test_with_light_tails_the_rate_is_told(tmp_path: Path) -> None:
    report_file = tmp_path / "r.json"
    scene = write_scene(tmp_path, hazy_moon())
    # Of 12 seeds one, 0, meets a sample that is too bright to certify.
    done = run_glimmer(scene, "-o", tmp_path / "out.exr", "--spp", 256, "--seed", 1, "--report", report_file)
    assert done.returncode == 0, done.stderr
    report = json.loads(report_file.read_text())
    assert report["error"]["tails"]["certifiable"] and "heavy" not in done.stderr
    rate = report["rate"]
    assert rate["low"] < rate["power"] < rate["high"] and rate["confidence"] == 0.95
    assert f"falls as time^{-rate['power']:.2f}" in done.stderr.splitlines()[-1]
    assert report["seconds_to_half"] > 0 and report["seconds_to_target"] is None
