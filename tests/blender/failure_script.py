# SPDX-License-Identifier: GPL-3.0-or-later
"""Breaks a scene in one way after another: failure_script.py FOLDER.

Each kind must raise one line in the caller and leave no file. Saves a broken scene for the runs without a script.
"""

import json
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import bpy

sys.path.insert(0, str(Path(__file__).parent))

import inside

OUT = Path(inside.words()[0])
glimmer = inside.enable()
from glimmer.native import library  # noqa: E402 - the add-on's name inside Blender


def flat_camera(scene: Any) -> None:
    scene.camera.scale.z = 0.0


def unreadable_mesh(scene: Any) -> None:
    bpy.data.objects["Ball"].data.vertices[3].co.x = float("nan")


def missing_library(scene: Any) -> None:
    os.environ["GLIMMER_LIBRARY"] = str(OUT / "nowhere.so")
    library.load.cache_clear()


def defect(scene: Any) -> None:
    """An exception that nobody thought of."""
    import glimmer.jobs

    def broken(*_: Any, **__: Any) -> None:
        raise ZeroDivisionError("thought of by nobody")

    glimmer.jobs.export_scene = broken


BREAKERS: tuple[Callable[[Any], None], ...] = (
    flat_camera,
    unreadable_mesh,
    missing_library,
    defect,
)

messages: dict[str, str] = {}
files: dict[str, list[str]] = {}
for breaker in BREAKERS:
    name = breaker.__name__
    scene = inside.empty_scene((0.5, 0.5, 0.5))
    inside.ball("Ball")
    folder = OUT / name
    folder.mkdir()
    inside.use_format("PNG")
    breaker(scene)
    if breaker is flat_camera:
        bpy.ops.wm.save_as_mainfile(filepath=str(OUT / "broken.blend"))
    messages[name] = ""
    for options in ({}, {"animation": True}):
        scene.frame_end = 2
        try:
            inside.render(folder / "picture", **options)
        except RuntimeError as error:
            messages[name] = str(error)
        else:
            messages[name] = "no exception"
            break
    files[name] = [path.name for path in folder.iterdir()]
(OUT / "facts.json").write_text(json.dumps({"messages": messages, "files": files}))
