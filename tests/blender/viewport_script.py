# SPDX-License-Identifier: GPL-3.0-or-later
"""Rendered shading in a window, step by step: viewport_script.py FOLDER.

Writes facts.json, and colors.png, a screenshot. A step returns True when it is done; it is asked again until then.
"""

import json
import subprocess
import sys
import threading
import time
import traceback
from collections.abc import Callable, Iterator
from dataclasses import asdict
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from bpy_extras.view3d_utils import location_3d_to_region_2d
from mathutils import Quaternion, Vector

sys.path.insert(0, str(Path(__file__).parent))

import inside

OUT = Path(inside.words()[0])
GIVE_UP_SECONDS = 200.0
WORLD = (0.2, 0.4, 0.1)
MOON = (0.8, 0.05, 0.6)
OTHER_MOON = (0.05, 0.6, 0.8)
SAMPLES = 4

glimmer = inside.enable()
from glimmer.viewport import redraw  # noqa: E402 - the add-on's name inside Blender
from glimmer.viewport.view import RenderedView  # noqa: E402

facts: dict[str, Any] = {"done": []}


def space() -> tuple[Any, Any, Any]:
    """The 3D view: its area, its space, and its main region."""
    screen = bpy.context.window_manager.windows[0].screen
    area = next(item for item in screen.areas if item.type == "VIEW_3D")
    return area, area.spaces[0], next(item for item in area.regions if item.type == "WINDOW")


def view() -> RenderedView | None:
    return next(iter(redraw.open_views()), None)


def is_settled() -> bool:
    """Whether the picture on the screen is the newest scene's, in full, with all its samples."""
    shown = view()
    if shown is None or shown.session is None or shown.drawn is None:
        return False
    frame = shown.drawn
    return frame.scene == shown.session.counts().scenes and frame.scale == 1 and frame.progress.samples >= SAMPLES


def threads() -> int:
    return sum(thread.name == "Glimmer view" for thread in threading.enumerate())


def note(name: str) -> None:
    shown = view()
    entry: dict[str, Any] = {"views": len(redraw.open_views()), "threads": threads()}
    if shown is not None and shown.session is not None:
        entry["counts"] = asdict(shown.session.counts())
        entry["reads"] = dict(shown.kept.reads)
        entry["failure"] = shown._failure or shown.session.failure()
        if shown.drawn is not None and shown.drawn.scale == 1:
            pixels = shown.drawn.pixels
            entry["size"] = pixels.shape[:2]
            entry["mean"] = [float(value) for value in pixels.mean(axis=(0, 1))]
            entry["moon"] = [float(value) for value in pixels[tuple(moon_pixel())]]
    facts[name] = entry


def note_window(name: str) -> None:
    shown = view()
    assert shown is not None and shown.session is not None and shown.drawn is not None
    region = space()[2]
    facts[name] = {
        "counts": asdict(shown.session.counts()),
        "window": shown.drawn.window,
        "region": (region.width, region.height),
        "scale": shown.drawn.scale,
        "is_resting": shown.session.is_resting(),
    }


def moon_pixel() -> tuple[int, int]:
    """Row from the top and column of the moon's centre, by Blender's own reckoning."""
    _, current, region = space()
    point = location_3d_to_region_2d(region, current.region_3d, bpy.data.objects["Moon"].location)
    return region.height - 1 - int(point.y), int(point.x)


def turn(degrees: float) -> None:
    _, current, region = space()
    current.region_3d.view_rotation = Quaternion((0.0, 0.0, 1.0), np.radians(degrees)) @ current.region_3d.view_rotation
    region.tag_redraw()


def moon_color(color: tuple[float, float, float]) -> None:
    node = bpy.data.objects["Moon"].active_material.node_tree.nodes["Emission"]
    node.inputs["Color"].default_value = (*color, 1.0)


def build() -> None:
    scene = inside.empty_scene(WORLD)
    scene.view_settings.view_transform = "Standard"
    scene.glimmer.viewport_samples = SAMPLES
    scene.glimmer.filter = "BOX"
    moon = inside.ball(
        "Moon", inside.material("ShaderNodeEmission", Color=(*MOON, 1.0), Strength=1.0), (-1.0, 0.0, 1.0)
    )
    moon.glimmer.is_sphere = True
    inside.ball("Ball", inside.material("ShaderNodeBsdfDiffuse"), (2.0, 0.0, 0.0), 16)


def show() -> None:
    _, current, _ = space()
    current.overlay.show_overlays = False
    current.show_gizmo = False
    current.shading.type = "RENDERED"
    current.region_3d.view_perspective = "PERSP"
    current.region_3d.view_location, current.region_3d.view_distance = Vector((0.0, 0.0, 0.0)), 9.0


def steps() -> Iterator[Callable[[], bool]]:
    """Each is asked until it is done; what stands between the yields happens once."""
    build()
    show()
    yield is_settled
    note("first")
    facts["first"]["moon_pixel"] = moon_pixel()
    facts["first"]["region"] = space()[2].x, space()[2].y
    facts["window_height"] = bpy.context.window_manager.windows[0].height
    subprocess.run(["import", "-window", "root", str(OUT / "colors.png")], check=True, timeout=30)

    for _ in range(5):
        seen = facts["turned"] = view().session.counts().scenes  # type: ignore[union-attr]
        turn(4.0)
        yield lambda seen=seen: view().session.counts().scenes > seen  # type: ignore[misc,union-attr]
    yield is_settled
    note("turned")

    moon_color(OTHER_MOON)
    yield lambda: is_settled() and view().session.counts().scenes > facts["turned"]["counts"]["scenes"]  # type: ignore[union-attr]
    note("recolored")

    bpy.data.objects["Camera"].select_set(True)
    bpy.data.objects["Ball"].select_set(True)
    yield waiting(1.0)
    note("selected")

    bpy.data.objects["Ball"].location.x += 0.5
    yield lambda: is_settled() and view().session.counts().scenes > facts["selected"]["counts"]["scenes"]  # type: ignore[union-attr]
    note("moved")
    bpy.data.objects["Ball"].name = "Other"
    yield waiting(1.0)
    note("renamed")

    bpy.data.objects["Other"].data.vertices[0].co.x += 0.1
    bpy.data.objects["Other"].data.update()
    yield lambda: is_settled() and view().session.counts().scenes > facts["renamed"]["counts"]["scenes"]  # type: ignore[union-attr]
    note("reshaped")

    space()[1].region_3d.view_perspective = "ORTHO"
    space()[2].tag_redraw()
    yield lambda: is_settled() and view().session.counts().scenes > facts["reshaped"]["counts"]["scenes"]  # type: ignore[union-attr]
    note("orthographic")

    space()[1].region_3d.view_perspective = "PERSP"
    space()[1].use_render_border = True
    space()[1].render_border_min_x, space()[1].render_border_max_x = 0.25, 0.75
    space()[1].render_border_min_y, space()[1].render_border_max_y = 0.5, 1.0
    space()[2].tag_redraw()
    yield lambda: is_settled() and view().session.counts().scenes > facts["orthographic"]["counts"]["scenes"]  # type: ignore[union-attr]
    note_window("border")
    space()[1].use_render_border = False
    space()[2].tag_redraw()
    yield lambda: is_settled() and view().session.counts().scenes > facts["border"]["counts"]["scenes"]  # type: ignore[union-attr]

    bpy.context.scene.glimmer.preview_pause = True
    yield lambda: view().session._is_held  # type: ignore[union-attr]
    paused = view().session.counts().scenes  # type: ignore[union-attr]
    moon_color(MOON)
    yield lambda: view().session.counts().scenes > paused and view().drawn.scene > paused  # type: ignore[union-attr]
    yield waiting(1.0)
    note_window("paused")
    bpy.context.scene.glimmer.preview_pause = False
    moon_color(OTHER_MOON)
    yield lambda: is_settled() and view().session.counts().scenes > facts["paused"]["counts"]["scenes"]  # type: ignore[union-attr]

    window, first_layer = bpy.context.window_manager.windows[0], bpy.context.window.view_layer
    second_layer = bpy.context.scene.view_layers.new("Second")
    bpy.data.objects["Moon"].hide_set(True, view_layer=second_layer)
    window.view_layer = second_layer
    yield waiting(1.0)
    yield is_settled
    note("second view layer")
    window.view_layer = first_layer
    bpy.context.scene.view_layers.remove(second_layer)
    yield waiting(1.0)
    yield is_settled

    camera = bpy.context.scene.camera.data
    camera.shift_x, camera.shift_y = 0.1, -0.15
    space()[1].region_3d.view_camera_offset = (0.05, 0.02)
    space()[1].region_3d.view_perspective = "CAMERA"
    space()[2].tag_redraw()
    yield is_settled
    note("camera")

    scene = bpy.context.scene
    scene.glimmer.samples = 4
    inside.use_format("OPEN_EXR")
    inside.render(OUT / "f12.exr")
    moon_color(MOON)
    yield lambda: is_settled() and view().session.counts().scenes > facts["camera"]["counts"]["scenes"]  # type: ignore[union-attr]
    note("after F12")

    bpy.ops.wm.save_as_mainfile(filepath=str(OUT / "saved.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(OUT / "saved.blend"), load_ui=False)
    facts["threads_after_load"] = threads()
    yield is_settled
    note("loaded")

    # Broken off in the midst of it.
    space()[1].region_3d.view_perspective = "PERSP"
    bpy.context.scene.glimmer.viewport_samples = 0
    yield lambda: view().session.counts().scenes > facts["loaded"]["counts"]["scenes"]  # type: ignore[union-attr]
    space()[1].shading.type = "SOLID"
    yield lambda: threads() == 0
    note("solid")

    space()[1].shading.type = "RENDERED"
    yield lambda: view() is not None and view().drawn is not None  # type: ignore[union-attr]
    glimmer.unregister()
    facts["threads_after_disable"] = threads()
    yield waiting(1.0)
    glimmer.register()
    bpy.context.scene.render.engine = "GLIMMER"
    yield lambda: view() is not None and view().drawn is not None  # type: ignore[union-attr]
    note("enabled again")
    # And Blender ends while the view goes on.


def waiting(seconds: float) -> Callable[[], bool]:
    end = time.monotonic() + seconds
    return lambda: time.monotonic() > end


script = steps()
current_step: list[Callable[[], bool]] = []


def finish() -> None:
    (OUT / "facts.json").write_text(json.dumps(facts))
    bpy.ops.wm.quit_blender()


def advance() -> float | None:
    if time.monotonic() > started + GIVE_UP_SECONDS:
        note("given up")
        finish()
        return None
    try:
        if not current_step or current_step[0]():
            current_step[:] = [next(script)]
            facts["done"].append(round(time.monotonic() - started, 1))
    except StopIteration:
        facts["is_finished"] = True
        finish()
        return None
    except Exception:  # noqa: BLE001 - it belongs into the test's output, and Blender must end
        facts["error"] = traceback.format_exc()
        finish()
        return None
    return 0.05


started = time.monotonic()
bpy.context.preferences.view.show_splash = False
bpy.app.timers.register(advance, first_interval=1.0, persistent=True)
