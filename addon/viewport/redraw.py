# SPDX-License-Identifier: GPL-3.0-or-later
"""Which views there are, and a timer that asks for a redraw of those that have something new.

The engine's threads never call Python, and Blender may be asked for a redraw by its own thread alone: so poll.
"""

from __future__ import annotations

import time
from weakref import ref

import bpy
from bpy.app.handlers import persistent

from . import session
from .view import RenderedView

REDRAW_SECONDS = 0.1
MOST_LATENESS_SECONDS = 1.0

_due = {"time": 0.0}  # when the timer should run next; 0 while it does not

_views: dict[RenderedView, ref[bpy.types.RenderEngine]] = {}


def open_views() -> list[RenderedView]:
    return list(_views)


def watch(engine: bpy.types.RenderEngine, view: RenderedView) -> None:
    """The view is closed when Blender drops the engine: there is no other word of its end."""
    if view not in _views:
        _views[view] = ref(engine, lambda _: _drop(view))
    if not bpy.app.timers.is_registered(_poll):
        bpy.app.timers.register(_poll, first_interval=REDRAW_SECONDS, persistent=True)


def _drop(view: RenderedView) -> None:
    view.close()
    _views.pop(view, None)


def _poll() -> float | None:
    """Also waits as long as the last redraw took, so that a slow display leaves time for the user's hands."""
    started = time.monotonic()
    lateness = max(started - _due["time"], 0.0) if _due["time"] else 0.0
    _ask_for_redraws()
    if not _views:
        _due["time"] = 0.0
        return None
    delay = REDRAW_SECONDS + min(lateness, MOST_LATENESS_SECONDS)
    _due["time"] = started + delay
    return delay


def _ask_for_redraws() -> None:
    is_rendering = bpy.app.is_job_running("RENDER")
    for view, reference in list(_views.items()):
        engine = reference()
        try:
            view.pause(is_rendering)
            if engine is not None and view.wants_draw():
                engine.tag_redraw()
        except ReferenceError:  # Blender has dropped the engine, and somebody still holds its shell
            _drop(view)


@persistent  # type: ignore[untyped-decorator]
def _on_render_init(*_: object) -> None:
    """At once, and also where a script renders, which lets no timer run. The timer lets the views go on."""
    session.pause_all(True)


@persistent  # type: ignore[untyped-decorator]
def _on_load_pre(*_: object) -> None:
    close_all()


@persistent  # type: ignore[untyped-decorator]
def _on_undo(*_: object) -> None:
    for view in open_views():
        view.forget()


def close_all() -> None:
    for view in open_views():
        _drop(view)
    session.close_all()


def register() -> None:
    bpy.app.handlers.load_pre.append(_on_load_pre)
    bpy.app.handlers.render_init.append(_on_render_init)
    bpy.app.handlers.undo_post.append(_on_undo)
    bpy.app.handlers.redo_post.append(_on_undo)


def unregister() -> None:
    bpy.app.handlers.redo_post.remove(_on_undo)
    bpy.app.handlers.undo_post.remove(_on_undo)
    bpy.app.handlers.render_init.remove(_on_render_init)
    bpy.app.handlers.load_pre.remove(_on_load_pre)
    if bpy.app.timers.is_registered(_poll):
        bpy.app.timers.unregister(_poll)
    close_all()
