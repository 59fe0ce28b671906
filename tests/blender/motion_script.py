# SPDX-License-Identifier: GPL-3.0-or-later
"""What moves, inside a Blender: motion_script.py FOLDER WHAT.

WHAT is "scene": writes still.json and START.json, CENTER.json, END.json of a scene in which everything moves, and
state.json, what the export left of the scene's frame. "pictures": pictures.npz, NAME.CYCLES and NAME.GLIMMER, each
(seeds, height, width, 3).
"""

import json
import math
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).parent))

import inside
from exact_cycles import set_up_cycles

OUT, WHAT = Path(inside.words()[0]), inside.words()[1]
SEEDS, SAMPLES = 4, 32
WIDTH, HEIGHT = 36, 24
OCHRE = (0.9, 0.6, 0.3, 1.0)

glimmer = inside.enable()
if not hasattr(bpy.types.Scene, "cycles"):
    bpy.ops.preferences.addon_enable(module="cycles")


def diffuse() -> Any:
    return inside.material("ShaderNodeBsdfDiffuse", Color=OCHRE)


def animate(item: Any, path: str, *keys: tuple[float, Any]) -> None:
    """Straight from each (frame, value) to the next."""
    for frame, value in keys:
        setattr(item, path, value)
        item.keyframe_insert(path, frame=frame)
    action = item.animation_data.action
    curves = action.fcurves if hasattr(action, "fcurves") else action.layers[0].strips[0].channelbags[0].fcurves
    for curve in curves:
        for point in curve.keyframe_points:
            point.interpolation = "LINEAR"


def blurred(shutter: float = 1.0, position: str = "CENTER") -> None:
    render = bpy.context.scene.render
    render.use_motion_blur, render.motion_blur_shutter = True, shutter
    owner = render if hasattr(render, "motion_blur_position") else bpy.context.scene.cycles
    owner.motion_blur_position = position


def box(name: str, **where: Any) -> Any:
    item = inside.ball(name, diffuse(), segments=4)
    item.data.polygons.foreach_set("use_smooth", [False] * len(item.data.polygons))
    for key, value in where.items():
        setattr(item, key, value)
    return item


def instanced(kind: str, item: Any, location: tuple[float, float, float]) -> Any:
    """A collection that holds the object, shown once."""
    collection = bpy.data.collections.new(kind)
    bpy.context.scene.collection.objects.unlink(item)
    collection.objects.link(item)
    empty = bpy.data.objects.new(kind, None)
    empty.instance_type, empty.instance_collection, empty.location = "COLLECTION", collection, location
    bpy.context.scene.collection.objects.link(empty)
    return empty


def moving_things() -> None:
    scene = inside.empty_scene((0.3, 0.4, 0.5))
    inside.plane(material=diffuse())
    animate(box("Slide"), "location", (0, (0.0, 0.0, 1.0)), (1, (0.0, 2.0, 1.0)), (2, (4.0, 2.0, 1.0)))
    animate(box("Turn"), "rotation_euler", (0, (0.0, 0.0, 0.0)), (2, (0.0, 0.0, math.pi)))
    fine = box("Fine")
    fine.cycles.motion_steps = 2
    animate(fine, "location", (0, (0.0, 0.0, 0.0)), (2, (4.0, 0.0, 0.0)))
    held = box("Held")
    held.cycles.use_motion_blur = False
    animate(held, "location", (0, (0.0, 0.0, 0.0)), (2, (4.0, 0.0, 0.0)))
    empty = instanced("Inner", box("Instance"), (0.0, 0.0, 3.0))
    animate(empty, "location", (0, (0.0, 0.0, 3.0)), (2, (2.0, 0.0, 3.0)))
    shining = inside.ball("Shining", inside.material("ShaderNodeEmission", Color=OCHRE), segments=4)
    animate(shining, "location", (0, (0.0, 0.0, 3.0)), (2, (2.0, 0.0, 3.0)))
    animate(inside.lamp("POINT", (0.0, 0.0, 5.0)), "location", (0, (0.0, 0.0, 5.0)), (2, (2.0, 0.0, 5.0)))
    vanishing = box("Vanishing")
    animate(vanishing, "hide_render", (0, False), (1, False), (1.2, True))
    bent = box("Bent")
    bent.modifiers.new("Wave", "WAVE")
    ball = inside.ball("Sphere", diffuse())
    ball.glimmer.is_sphere = True
    animate(ball, "location", (0, (0.0, 0.0, 3.0)), (2, (2.0, 0.0, 3.0)))
    animate(scene.camera, "location", (0, (0.0, -6.0, 5.0)), (2, (2.0, -6.0, 5.0)))


def write_scenes() -> None:
    moving_things()
    scene = bpy.context.scene
    state = {}
    bpy.ops.glimmer.export_scene(filepath=str(OUT / "still.json"))
    for position in ("START", "CENTER", "END"):
        blurred(1.0, position)
        bpy.ops.glimmer.export_scene(filepath=str(OUT / f"{position}.json"))
        state[position] = {
            "frame": scene.frame_current + scene.frame_subframe,
            "place": list(bpy.data.objects["Slide"].matrix_world.translation),
            "notices": glimmer.reports.last()["export"]["notices"],
        }
    (OUT / "state.json").write_text(json.dumps(state))


def stage() -> Any:
    scene = inside.empty_scene((0.4, 0.4, 0.5))
    inside.plane(material=inside.material("ShaderNodeBsdfDiffuse", Color=(0.7, 0.6, 0.5, 1.0)))
    inside.lamp("AREA", (-3.0, -2.0, 4.0), energy=200.0, shape="RECTANGLE", size=2.0, size_y=1.0)
    return scene


def moving_ball() -> None:
    stage()
    ball = box("Ball")
    animate(ball, "location", (0, (-2.0, 0.0, 1.0)), (1, (0.0, 0.0, 1.5)), (2, (2.5, 1.0, 1.0)))
    blurred(1.0)


def turning_bar() -> None:
    """Fast: a third of a turn while the shutter is open, about a place beside it."""
    stage()
    bar = box("Bar", scale=(2.0, 0.3, 0.3))
    bar.location.z = 1.0
    animate(bar, "rotation_euler", (0, (0.0, 0.0, 0.0)), (2, (0.3, 0.2, 4.0)))
    blurred(1.0, "START")


def moving_camera() -> None:
    scene = stage()
    box("Ball", location=(0.0, 0.0, 1.0))
    camera = scene.camera
    animate(camera, "location", (0, (-2.0, -6.0, 5.0)), (2, (2.0, -6.0, 5.0)))
    animate(camera, "rotation_euler", (0, (0.8, 0.0, -0.2)), (2, (1.0, 0.2, 0.4)))
    blurred(0.8, "END")


def gradual_shutter() -> None:
    moving_ball()
    mapping = bpy.context.scene.render.motion_blur_shutter_curve
    points = mapping.curves[0].points
    points[0].location, points[1].location, points[-1].location = (0.0, 0.0), (0.5, 0.2), (1.0, 1.0)
    for point in points:
        point.handle_type = "VECTOR"
    mapping.update()


PICTURES: dict[str, Callable[[], None]] = {
    "moving ball": moving_ball,
    "turning bar": turning_bar,
    "moving camera": moving_camera,
    "gradual shutter": gradual_shutter,
}


def picture(engine: str, seed: int) -> Any:
    return inside.picture(OUT / "picture.exr", engine, seed)


def write_pictures() -> None:
    inside.use_format("OPEN_EXR")
    pictures: dict[str, Any] = {}
    for name, build in PICTURES.items():
        build()
        scene = bpy.context.scene
        scene.render.resolution_x, scene.render.resolution_y = WIDTH, HEIGHT
        scene.glimmer.samples, scene.glimmer.filter = SAMPLES, "BOX"
        set_up_cycles(scene, samples=SAMPLES)
        for engine in ("CYCLES", "GLIMMER"):
            pictures[f"{name}.{engine}"] = np.array([picture(engine, seed) for seed in range(SEEDS)])
    np.savez(OUT / "pictures.npz", **pictures)


if WHAT == "scene":
    write_scenes()
else:
    write_pictures()
