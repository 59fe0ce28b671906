# SPDX-License-Identifier: GPL-3.0-or-later
"""Everything that the add-on registers, in order. `unregister` goes the same way back."""

import atexit

from . import curve_files, engine, failure, hexfield, moons, operators, properties, reports, ui
from .native import render
from .viewport import redraw
from .viewport import session as view_session

_PARTS = (properties, reports, failure, curve_files, engine, redraw, operators, hexfield, moons, ui)
_registered: list[object] = []


def register() -> None:
    try:
        for part in _PARTS:
            part.register()
            _registered.append(part)
    except Exception:
        unregister()
        raise
    # The bpy module crashes or hangs at exit while an engine is registered; the executable has freed Blender's side by
    # then, and only our own memory is left.
    atexit.register(unregister if failure.is_module() else _close_all)


def _close_all() -> None:
    view_session.close_all()
    render.close_all()


def unregister() -> None:
    atexit.unregister(unregister)
    atexit.unregister(_close_all)
    _close_all()
    while _registered:
        _registered.pop().unregister()  # type: ignore[attr-defined]
