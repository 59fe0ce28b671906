# SPDX-License-Identifier: GPL-3.0-or-later
"""Every node and its options, as emission, shows in Glimmer what it shows in Cycles, pixel by pixel."""

import json
from pathlib import Path
from typing import Any

import pytest
from hosts import Host

SCRIPT = Path(__file__).with_name("shading_script.py")

# The part of a patch's pixels that may differ: cells of a texture meet there, and rounding decides which one a pixel
# shows. What is not named here has edges nowhere, or few.
EDGES = {
    "Closest": 0.08,
    "white noise": 0.08,
    "WRAP": 0.14,
    "MODULO": 0.13,
    "SNAP": 0.12,
    "TANGENT": 0.12,
    "PINGPONG": 0.08,
    "image BOX": 0.05,
    "HUE": 0.08,
    "SINGLE_SCATTERING": 0.08,  # beneath the horizon Blender's sky fades a little otherwise
}
FEW = 0.05


# What lies between the oldest Blender and the newest is slow to try and seldom fails alone.
oldest_and_newest = pytest.mark.parametrize(
    "host", ["blender", pytest.param("bpy", marks=pytest.mark.full), "newest"], indirect=True, scope="session"
)


@pytest.fixture(
    scope="module", params=["noises", "voronois", "patterns", "numbers", "colors", "images", "surfaces", "skies"]
)
def found(request: pytest.FixtureRequest, host: Host, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    path = tmp_path_factory.mktemp(request.param) / "facts.json"
    host.run_script(SCRIPT, str(path), request.param)
    result: dict[str, Any] = json.loads(path.read_text())
    return result


@oldest_and_newest
def test_nodes_show_what_they_show_in_cycles(found: dict[str, Any]) -> None:
    assert len(found["cases"]) >= 7
    wrong = {}
    for name, case in found["cases"].items():
        allowed = next((part for words, part in EDGES.items() if words in name), FEW)
        if case["off"] > allowed:
            wrong[name] = case
    assert not wrong, json.dumps(wrong, indent=1)


@oldest_and_newest
def test_nothing_is_told_to_be_left_out(found: dict[str, Any]) -> None:
    # But for what no renderer with light vertices can know.
    assert [notice for notice in found["report"]["export"]["notices"] if "'Light Path'" not in notice] == []
    assert "no textures: no shader programs" not in found["report"]["left_out"]
