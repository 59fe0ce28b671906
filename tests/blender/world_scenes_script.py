# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders the scenes of Glimmer worlds small, with the passes that test_world_scenes.py judges, and writes where their
moons' orbits say that they are seen.

    blender -b --python world_scenes_script.py -- FOLDER NAME...
"""

import importlib
import json
import sys
from pathlib import Path
from typing import Any

import bpy
from bpy_extras.object_utils import world_to_camera_view
from mathutils import Vector

sys.path.insert(0, str(Path(__file__).parent))
from inside import render, use_format, words

SCENES = Path(__file__).resolve().parents[2] / "blend_scenes"
sys.path.insert(0, str(SCENES))
stage = importlib.import_module("stage")


def passes(scene: Any) -> None:
    layer = scene.view_layers[0]
    layer.use_pass_z = layer.use_pass_object_index = True
    layer.glimmer.use_fog = layer.glimmer.use_stderr = layer.glimmer.use_emission = True
    # 1: plates, whose shapes are objects out of the scene; above: moons.
    is_moon = stage.tools("moons.moon").emission_node
    for index, obj in enumerate(bpy.data.objects):
        obj.pass_index = 1 if is_moon(obj) is None else 2 + index
    scene.render.resolution_x, scene.render.resolution_y = 96, 54
    scene.glimmer.samples = 8
    use_format("OPEN_EXR_MULTILAYER")


def moons(scene: Any) -> dict[str, Any]:
    """Where Kepler's closed form sees the moons that shine evenly: in the picture from 0 to 1, right and up."""
    seen = {}
    for obj in scene.objects:
        if obj.glimmer_orbit.enabled and obj.glimmer.is_sphere:
            place = stage.tools("moons.orbit").read(obj).place(scene.frame_current)
            color = obj.active_material.node_tree.nodes["Emission"].inputs["Color"].default_value
            seen[obj.name] = {
                "at": list(world_to_camera_view(scene, scene.camera, Vector(place))),
                "color": list(color)[:3],
                "index": obj.pass_index,
            }
    return seen


def main(folder: Path, names: list[str]) -> None:
    stage.addon()
    facts = {}
    for name in names:
        bpy.ops.wm.open_mainfile(filepath=str(SCENES / f"{name}.blend"))
        scene = bpy.context.scene
        passes(scene)
        first = scene.frame_current
        for frame in (first, first + 100) if scene.frame_end == 100 else (first,):
            scene.frame_set(frame)
            picture = f"{name}_{frame - first}"
            render(folder / f"{picture}.exr")
            facts[picture] = moons(scene)
    (folder / "facts.json").write_text(json.dumps(facts))


if __name__ == "__main__":
    out, *scenes = words()
    main(Path(out), scenes)
