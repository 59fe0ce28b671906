# SPDX-License-Identifier: GPL-3.0-or-later
"""The scenes of Glimmer worlds, rendered small: lit by haze, without an end in sight, moons in place."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hosts import Host
from test_render import Pixels, channels, layer_pass

NAMES = ("horizon", "dunes", "eclipse", "five_moons_orbit")
LAYER = "ViewLayer"


@pytest.fixture(scope="module")
def out(host: Host, tmp_path_factory: pytest.TempPathFactory) -> Path:
    if host.kind != "blender":
        pytest.skip("one host is enough: test_scenes.py holds the others against it")
    folder = tmp_path_factory.mktemp("worlds")
    host.run_script(Path(__file__).with_name("world_scenes_script.py"), str(folder), *NAMES, timeout=280)
    return folder


def light(found: dict[str, Pixels], name: str = "Combined") -> Pixels:
    return layer_pass(found, LAYER, name, "RGB")


@pytest.mark.parametrize("name", NAMES)
def test_most_light_comes_from_the_haze_and_its_error_is_known(out: Path, name: str) -> None:
    found = channels(out / f"{name}_0.exr")
    combined, fog, error = light(found), light(found, "Fog"), light(found, "Standard Error")
    for pixels in (combined, fog, error):
        assert np.isfinite(pixels).all()
    assert (combined > 0.0).mean() > 0.999  # a pixel may be negative within its noise
    # By median, which moons seen directly cannot carry.
    assert np.median(fog.sum(axis=2) / combined.sum(axis=2)) > 0.5
    assert 0.0 < np.median(error) < 0.5 * np.median(combined)


@pytest.mark.parametrize("name", NAMES)
def test_plates_fill_the_picture_up_to_the_horizon(out: Path, name: str) -> None:
    found = channels(out / f"{name}_0.exr")
    is_land = found[f"{LAYER}.IndexOB.X"] == 1.0
    is_empty = found[f"{LAYER}.Depth.Z"] > 1e4
    top = np.argmax(is_land, axis=0)
    assert is_land.any(axis=0).all(), "columns without any plate"
    assert np.ptp(top) > 2  # hills, not a plain
    rows = np.arange(is_land.shape[0])[:, np.newaxis]
    assert not (is_empty & (rows > top + 1)).any()
    assert is_empty[:8].mean() > 0.5  # the sky, so that the above can fail


def test_moons_stand_where_their_orbits_say(out: Path) -> None:
    facts: dict[str, dict[str, Any]] = json.loads((out / "facts.json").read_text())
    seen = 0
    for picture in ("horizon_0", "five_moons_orbit_0"):
        found = channels(out / f"{picture}.exr")
        emission, index = light(found, "Seen Emission"), found[f"{LAYER}.IndexOB.X"]
        height, width = emission.shape[:2]
        for moon in facts[picture].values():
            x, y, _ = moon["at"]
            if not (0.0 < x < 1.0 and 0.0 < y < 1.0):
                continue
            row, column = int((1.0 - y) * height), int(x * width)
            if index[row, column] == moon["index"]:  # else a hill or the black moon hides it
                seen += 1
                pixel = emission[row, column]
                # The haze dims all colours alike.
                np.testing.assert_allclose(pixel / pixel.max(), np.array(moon["color"]) / max(moon["color"]), atol=0.05)
    assert seen >= 6


def test_the_loop_closes(out: Path) -> None:
    first, last = (light(channels(out / f"five_moons_orbit_{frame}.exr")) for frame in (0, 100))
    difference = np.abs(first - last) / (first + last).clip(1e-6)
    assert np.median(difference) < 0.01
    assert difference.mean() < 0.05
