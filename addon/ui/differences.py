# SPDX-License-Identifier: GPL-3.0-or-later
"""What of this file differs from Cycles, shown before anybody renders: for all of it, and for a material on its tab.

Looked for when a panel is drawn and something that matters has changed, and not more often than is bearable: the file's
nodes are translated for it, as for a render.
"""

import time
from dataclasses import dataclass
from typing import Any

import bpy
from bpy.app.handlers import persistent

from ..export.differences import find_differences
from ..scene.problems import Notice, describe
from .panel import GlimmerPanel, wrapped

MOST_LINES = 40  # that a panel shows
PATIENCE = 10.0  # times what a search takes, until the next one
_WATCHED = ("Material", "World", "Light", "NodeTree", "ShaderNodeTree", "Image", "Scene", "Camera", "Collection")


@dataclass
class _State:
    scene: str = ""
    found: tuple[Notice, ...] = ()
    is_stale: bool = True
    next_search: float = 0.0


_state = _State()


def differences(context: bpy.types.Context) -> tuple[Notice, ...]:
    scene = context.scene.name_full
    if _state.scene != scene or (_state.is_stale and time.monotonic() >= _state.next_search):
        begin = time.monotonic()
        try:
            _state.found = find_differences(context.evaluated_depsgraph_get(), bpy.app.version)
        except Exception as error:  # noqa: BLE001 - a panel that cannot be drawn hides all below it
            _state.found = (Notice("", describe(error)),)
        end = time.monotonic()
        _state.scene, _state.is_stale = scene, False
        _state.next_search = end + PATIENCE * (end - begin)
    return _state.found


def of_material(found: tuple[Notice, ...], name: str) -> list[Notice]:
    return [notice for notice in found if f"material '{name}'" in notice.where]


def draw_notices(layout: bpy.types.UILayout, notices: list[Notice], context: bpy.types.Context) -> None:
    column = layout.column(align=True)
    lines = 0
    for number, notice in enumerate(notices):
        texts = wrapped(str(notice), context)
        if lines + len(texts) > MOST_LINES:
            column.label(text=f"and {len(notices) - number} more, which a render lists in the info log", icon="BLANK1")
            return
        for index, line in enumerate(texts):
            column.label(text=line, icon="BLANK1" if index else "INFO")
        lines += len(texts)


class GLIMMER_PT_differences(GlimmerPanel, bpy.types.Panel):
    bl_label = "Differs from Cycles"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header_preset(self, context: bpy.types.Context) -> None:
        count = len(differences(context))
        if count:
            self.layout.label(text=str(count))

    def draw(self, context: bpy.types.Context) -> None:
        found = list(differences(context))
        if found:
            draw_notices(self.layout, found, context)
        else:
            self.layout.label(text="Everything is rendered as Cycles does", icon="CHECKMARK")


class GLIMMER_PT_material_differences(GlimmerPanel, bpy.types.Panel):
    bl_label = "Differs from Cycles"
    bl_context = "material"
    bl_order = -1

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.material is not None and bool(_of(context))

    def draw(self, context: bpy.types.Context) -> None:
        draw_notices(self.layout, _of(context), context)


def _of(context: bpy.types.Context) -> list[Notice]:
    return of_material(differences(context), context.material.name)


@persistent  # type: ignore[untyped-decorator]
def _on_update(_scene: Any, depsgraph: Any = None) -> None:
    if depsgraph is None or any(_matters(update) for update in depsgraph.updates):
        _state.is_stale = True


def _matters(update: Any) -> bool:
    """Whether more has changed than where something stands."""
    kind = type(update.id).__name__
    return kind in _WATCHED or kind.endswith("Light") or (kind == "Object" and not update.is_updated_transform)


@persistent  # type: ignore[untyped-decorator]
def _on_load(*_: Any) -> None:
    _state.scene, _state.is_stale = "", True


_CLASSES = (GLIMMER_PT_differences, GLIMMER_PT_material_differences)


def register() -> None:
    for panel in _CLASSES:
        bpy.utils.register_class(panel)
    bpy.app.handlers.depsgraph_update_post.append(_on_update)
    bpy.app.handlers.load_post.append(_on_load)


def unregister() -> None:
    bpy.app.handlers.load_post.remove(_on_load)
    bpy.app.handlers.depsgraph_update_post.remove(_on_update)
    for panel in reversed(_CLASSES):
        bpy.utils.unregister_class(panel)
