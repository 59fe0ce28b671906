# SPDX-License-Identifier: GPL-3.0-or-later
"""Everything that the add-on registers, in order. `unregister` goes the same way back.

Who installed Glimmer as an add-on and as an extension has two packages of it. Only the one that comes first registers:
the classes of the second would take the place of the first one's.
"""

import atexit
import logging
import sys

import bpy

from . import (
    callbacks,
    curve_files,
    engine,
    failure,
    frame_files,
    haze,
    hexfield,
    moons,
    operators,
    properties,
    reports,
    ui,
    worlds,
)
from .cluster import render as cluster_render
from .native import library, render
from .scene.problems import GlimmerError
from .viewport import redraw
from .viewport import session as view_session

_PARTS = (
    properties,
    reports,
    failure,
    frame_files,
    curve_files,
    engine,
    redraw,
    operators,
    hexfield,
    moons,
    haze,
    worlds,
    ui,
)
_registered: list[object] = []
_log = logging.getLogger(__name__)


def register() -> None:
    other = _package_at_work()
    if other not in (None, __package__):
        text = (
            f"Glimmer is installed twice: {other} ({_folder(other)}) is at work, and {__package__}"
            f" ({_folder(__package__)}) does nothing; remove one of them in Preferences > Add-ons and start Blender"
            " again"
        )
        _log.error("%s", text)
        ui.preferences.register_notice(text)
        _registered.append(ui.preferences)
        return
    try:
        library.find()
    except GlimmerError as error:  # the preferences and the render properties say so too
        _log.error("%s", error)
    try:
        for part in _PARTS:
            part.register()
            _registered.append(part)
    except Exception:
        unregister()
        raise
    # The bpy module crashes or hangs at exit while an engine is registered; the executable has freed Blender's side by
    # then, and only our own memory is left.
    if failure.is_module():
        atexit.unregister(callbacks.forget)
        atexit.register(callbacks.forget)  # stays when the add-on is disabled, and runs after `unregister`
        atexit.register(unregister)
    else:
        atexit.register(_close_all)


def _package_at_work() -> str | None:
    """The package whose render engine is registered."""
    for cls in bpy.types.RenderEngine.__subclasses__():
        if getattr(cls, "bl_idname", "") == engine.GlimmerRenderEngine.bl_idname and cls.is_registered:
            return str(cls.__module__.rpartition(".")[0])
    return None


def _folder(package: str | None) -> str:
    module = sys.modules.get(package or "")
    return str(module.__path__[0]) if module is not None else "gone"


def _close_all() -> None:
    view_session.close_all()
    cluster_render.close_all()
    render.close_all()


def unregister() -> None:
    atexit.unregister(unregister)
    atexit.unregister(_close_all)
    _close_all()
    while _registered:
        _registered.pop().unregister()  # type: ignore[attr-defined]
