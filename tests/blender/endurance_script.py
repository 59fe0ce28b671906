# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders many times in one window, stops them at random moments, and disturbs Blender between them:
endurance_script.py FOLDER COUNT.

Every render is stopped by Escape or, where the window is too slow for the moment, by the engine's own cancel. Writes
facts.json: after each, what there still is of renders, threads and memory.
"""

import gc
import json
import os
import random
import subprocess
import sys
import threading
import time
import traceback
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import bpy

sys.path.insert(0, str(Path(__file__).parent))

import inside

OUT, COUNT = Path(inside.words()[0]), int(inside.words()[1])
MOST_SECONDS_A_RENDER = 60.0
PAGE = os.sysconf("SC_PAGE_SIZE")

glimmer = inside.enable()
from glimmer.native import render as native  # noqa: E402 - the add-on's name inside Blender
from glimmer.scene.problems import GlimmerError  # noqa: E402
from glimmer.viewport import redraw  # noqa: E402

choice = random.Random(5)
facts: dict[str, Any] = {"rounds": [], "film_bytes": 0}


def view() -> Any:
    screen = bpy.context.window_manager.windows[0].screen
    return next(area for area in screen.areas if area.type == "VIEW_3D")


def build() -> None:
    inside.endless_scene(800, 500)
    bpy.context.preferences.view.render_display_type = "NONE"
    bpy.context.preferences.view.show_splash = False


# ---- What happens between renders ----


def load_file() -> None:
    bpy.ops.wm.open_mainfile(filepath=str(OUT / "scene.blend"), load_ui=False)


def undo() -> None:
    window = bpy.context.window_manager.windows[0]
    with bpy.context.temp_override(window=window, screen=window.screen, area=view()):
        bpy.data.objects["Ball"].location.x += 0.1
        bpy.ops.ed.undo_push(message="Moved")
        bpy.data.objects["Ball"].location.x += 0.1
        bpy.ops.ed.undo_push(message="Moved")
        bpy.ops.ed.undo()


def switch_off_and_on() -> None:
    glimmer.unregister()
    glimmer.register()
    bpy.context.scene.render.engine = "GLIMMER"
    bpy.context.scene.glimmer.samples = 1_000_000


def show_view() -> None:
    view().spaces[0].shading.type = "RENDERED"


def hide_view() -> None:
    view().spaces[0].shading.type = "SOLID"


def nothing() -> None:
    pass


# In few rounds no view is shown. With one, Blender 3.4 was once seen to refuse every change of its data from then on
# ("can't modify blend data in this state"), so that the rounds could not go on; why is not known.
VIEWS: tuple[Callable[[], None], ...] = (show_view, hide_view) if COUNT > 100 else ()
DISTURBANCES: tuple[Callable[[], None], ...] = (load_file, undo, switch_off_and_on, *VIEWS, nothing)


# ---- Rounds ----


def is_rendering() -> bool:
    return bool(bpy.app.is_job_running("RENDER"))


def stop() -> str:
    if choice.random() < 0.5:
        try:
            renders = [item for item in native.open_renders.all() if item not in _views_renders()]
            if renders:
                facts["film_bytes"] = max(facts["film_bytes"], renders[0].poll().peak_bytes)
                renders[0].cancel()
                return "cancel"
        except GlimmerError:  # Blender's thread has closed it meanwhile
            return "too late"
    subprocess.run(["xdotool", "key", "Escape"], check=True, timeout=20)
    return "escape"


def _views_renders() -> list[Any]:
    sessions = [item.session for item in redraw.open_views() if item.session is not None]
    return [session._running.render for session in sessions if session._running is not None]


def after(seconds: float) -> Callable[[], bool]:
    end = time.monotonic() + seconds
    return lambda: time.monotonic() > end


def rounds() -> Iterator[Callable[[], bool]]:
    """Each is asked until it is done."""
    build()
    bpy.ops.wm.save_as_mainfile(filepath=str(OUT / "scene.blend"))
    for index in range(COUNT):
        bpy.ops.render.render("INVOKE_DEFAULT")
        yield after(choice.choice((0.0, 0.05, 0.3, 0.8)) * choice.random())
        stops, asked = [], 0.0
        while is_rendering():
            if time.monotonic() > asked + 3.0:  # a key that came too early is lost
                stops.append(stop())
                asked = time.monotonic()
            yield after(0.02)
        disturbance = DISTURBANCES[index % len(DISTURBANCES)]
        disturbance()
        yield after(0.1)
        gc.collect()
        facts["rounds"].append(
            {
                "stops": stops,
                "then": disturbance.__name__,
                # A view may be about to begin one.
                "renders": None if redraw.open_views() else len(native.open_renders.all()),
                "tasks": len(list(Path("/proc/self/task").iterdir())),
                "bytes": int(Path("/proc/self/statm").read_text().split()[1]) * PAGE,
            }
        )
        (OUT / "facts.json").write_text(json.dumps(facts))
    hide_view()
    yield lambda: not redraw.open_views() and all(item.name != "Glimmer view" for item in threading.enumerate())
    facts["tasks_at_the_end"] = len(list(Path("/proc/self/task").iterdir()))
    facts["renders_at_the_end"] = len(native.open_renders.all())


script = rounds()
step: list[Callable[[], bool]] = []
deadline = [time.monotonic() + COUNT * MOST_SECONDS_A_RENDER]


def finish() -> float | None:
    """Quits, which Blender refuses while it renders: then stops that, and wants to be asked again."""
    (OUT / "facts.json").write_text(json.dumps(facts))
    for item in native.open_renders.all():
        item.cancel()
    try:
        bpy.ops.wm.quit_blender()
    except RuntimeError:
        return 0.5
    return None


def advance() -> float | None:
    if "is_finished" in facts or "error" in facts:
        return finish()
    try:
        if time.monotonic() > deadline[0]:
            raise TimeoutError("the rounds did not end")
        if not step or step[0]():
            step[:] = [next(script)]
    except StopIteration:
        facts["is_finished"] = True
    except Exception:  # noqa: BLE001 - it belongs into the test's output, and Blender must end
        facts["error"] = traceback.format_exc()
    return 0.01


bpy.app.timers.register(advance, first_interval=1.0, persistent=True)
