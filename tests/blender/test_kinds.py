# SPDX-License-Identifier: GPL-3.0-or-later
"""Kinds of things that people's files hold show in Glimmer what they show in Cycles."""

import json
from pathlib import Path

import pytest
from hosts import Host

SCRIPT = Path(__file__).with_name("kinds_script.py")
APART = 0.02  # of the picture's brightest block

# What is told though it shows what Cycles shows, by a word of the notice.
TOLD = {
    "without_an_output": "as in Cycles",
    "without_a_shader": "as in Cycles",
    "world_without_its_image": "as in Cycles",
    "rays_of_mixed_closures": "asked for as by a diffuse ray",
}
# What differs, and is told.
DIFFERS = {
    "normals_that_face_away": "custom normals that face away",
    "culled": "culling by the camera",
    "diced": "adaptive subdivision",
    "light_left_out": "(no refractive caustics, at most 3 transmission bounces)",
}

# What Blender hands over from 5.0 on.
MADE = ("made_instances", "made_by_a_curve", "made_within_collections")


# What lies between the oldest Blender and the newest is slow to try and seldom fails alone.
@pytest.mark.parametrize(
    "host", ["blender", pytest.param("bpy", marks=pytest.mark.full), "newest"], indirect=True, scope="session"
)
def test_kinds_show_what_they_show_in_cycles(host: Host, tmp_path: Path) -> None:
    path = tmp_path / "facts.json"
    host.run_script(SCRIPT, str(path))
    found = json.loads(path.read_text())
    later = {} if host.is_module else dict.fromkeys(MADE, "Blender hands them over from 5.0 on")
    for name, words in (DIFFERS | later).items():
        case = found.pop(name)
        assert case["apart"] > APART and words in case["notices"][0]
    assert {name: case for name, case in found.items() if case["apart"] > APART} == {}
    told = {name: case["notices"] for name, case in found.items() if case["notices"]}
    assert told.keys() == TOLD.keys(), told
    assert all(TOLD[name] in notice for name, notices in told.items() for notice in notices)
