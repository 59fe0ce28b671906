# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders in a window until somebody presses Escape: window_script.py FOLDER [SCHEDULER].

Writes `ready` when the picture has begun to appear, and at the end facts.json and kept.exr, the picture as it was kept.
"""

import json
import sys
import time
from pathlib import Path
from typing import Any

import bpy

sys.path.insert(0, str(Path(__file__).parent))

import inside

OUT, SCHEDULER = Path(inside.words()[0]), inside.words()[1:]
GIVE_UP_SECONDS = 60.0
glimmer = inside.enable()
from glimmer import reports  # noqa: E402 - the add-on's name inside Blender

facts: dict[str, Any] = {"ticks": [], "started": None, "ended": None}


def finish() -> None:
    inside.use_format("OPEN_EXR")
    bpy.data.images["Render Result"].save_render(str(OUT / "kept.exr"))
    (OUT / "written").write_text(json.dumps(facts))
    (OUT / "written").rename(OUT / "facts.json")  # as a whole: it is waited for
    bpy.ops.wm.quit_blender()


def watch() -> float | None:
    now = time.time()
    if facts["started"] is None:
        begin()
        facts["started"] = now
        return 0.05
    if not bpy.app.is_job_running("RENDER"):
        facts["ended"] = now
        finish()
        return None
    if now > facts["started"] + GIVE_UP_SECONDS:
        finish()
        return None
    facts["ticks"].append(now)
    if len(facts["ticks"]) > 2 and now > facts["started"] + 3.0 and reports.last().get("spp", 0) > 0:
        (OUT / "ready").touch()
    return 0.05


def begin() -> None:
    inside.endless_scene(640, 400)
    bpy.context.scene.glimmer.use_cluster = bool(SCHEDULER)
    window = bpy.context.window_manager.windows[0]
    with bpy.context.temp_override(window=window, screen=window.screen, area=window.screen.areas[0]):
        bpy.ops.render.render("INVOKE_DEFAULT")


bpy.app.timers.register(watch, first_interval=1.0)
