# SPDX-License-Identifier: GPL-3.0-or-later
"""Animated fields, materials that are put into a field's slots, and the end of prototypes that nobody uses.

Property callbacks do not fire when an animation changes a value, so a handler looks after every change of frame.
While rendering, it runs on the render thread: it touches nothing but the data of animated fields whose values really
changed, and Blender evaluates those a second time after it. A viewport that redraws the same data at that moment can
crash, which "Lock Interface" prevents: the panel says so.
"""

import logging
from typing import Any

import bpy
from bpy.app.handlers import persistent

from . import field, properties, slots

_log = logging.getLogger(__name__)


@persistent  # type: ignore[untyped-decorator]
def on_frame_change(scene: Any, depsgraph: Any = None) -> None:
    for obj in scene.objects:
        if obj.type != "MESH" or obj.animation_data is None or not obj.glimmer_field.enabled:
            continue
        # The animated values are those of the evaluated object: in a render the original keeps the old ones.
        source = obj if depsgraph is None else obj.evaluated_get(depsgraph)
        try:
            field.rebuild(obj, properties.read(source.glimmer_field))
        except ValueError as error:
            _log.warning("%s: %s; the field stays as it was", obj.name, error)


@persistent  # type: ignore[untyped-decorator]
def on_update(_scene: Any, depsgraph: Any) -> None:
    if bpy.app.is_job_running("RENDER"):
        return
    for update in depsgraph.updates:
        if isinstance(update.id, bpy.types.Object):
            obj = update.id.original
            if obj.glimmer_field.enabled and slots.is_writable(obj):
                slots.lead_pointers(obj)


@persistent  # type: ignore[untyped-decorator]
def on_load(*_: Any) -> None:
    """Files of before there were slots."""
    for obj in bpy.data.objects:
        if obj.glimmer_field.enabled and slots.is_writable(obj) and len(obj.material_slots) < slots.COUNT:
            slots.follow_pointers(obj)


@persistent  # type: ignore[untyped-decorator]
def on_save(*_: Any) -> None:
    field.sweep()


def register() -> None:
    bpy.app.handlers.frame_change_post.append(on_frame_change)
    bpy.app.handlers.depsgraph_update_post.append(on_update)
    bpy.app.handlers.load_post.append(on_load)
    bpy.app.handlers.save_pre.append(on_save)


def unregister() -> None:
    bpy.app.handlers.save_pre.remove(on_save)
    bpy.app.handlers.load_post.remove(on_load)
    bpy.app.handlers.depsgraph_update_post.remove(on_update)
    bpy.app.handlers.frame_change_post.remove(on_frame_change)
