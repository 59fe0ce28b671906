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
        if obj.type != "MESH" or not obj.glimmer_field.enabled:
            continue
        own = obj.glimmer_field
        if obj.animation_data is not None:
            # The animated values are those of the evaluated object: in a render the original keeps the old ones.
            _rebuild(obj, obj if depsgraph is None else obj.evaluated_get(depsgraph), depsgraph)
        elif own.ground is not None:
            _rebuild(obj, obj, depsgraph)
        elif own.simplify and slots.is_writable(obj):
            field.simplify(obj, properties.read(own), depsgraph)


def _rebuild(obj: Any, source: Any, depsgraph: Any) -> None:
    try:
        field.rebuild(obj, properties.read(source.glimmer_field), depsgraph)
    except ValueError as error:
        _log.warning("%s: %s; the field stays as it was", obj.name, error)


@persistent  # type: ignore[untyped-decorator]
def on_update(scene: Any, depsgraph: Any) -> None:
    if bpy.app.is_job_running("RENDER"):
        return
    changed = set()
    for update in depsgraph.updates:
        if isinstance(update.id, bpy.types.Object):
            obj = update.id.original
            changed.add(obj)
            if obj.glimmer_field.enabled and slots.is_writable(obj):
                slots.lead_pointers(obj)
    if changed:
        _follow(scene, changed, depsgraph)


def _follow(scene: Any, changed: set[Any], depsgraph: Any) -> None:
    """Fields stand on what was moved or edited, and are as fine as the camera sees them."""
    for obj in scene.objects:
        if obj.type != "MESH" or not obj.glimmer_field.enabled or not slots.is_writable(obj):
            continue
        own = obj.glimmer_field
        if own.ground is not None and (own.ground in changed or obj in changed):
            _rebuild(obj, obj, depsgraph)
        elif own.simplify and (scene.camera in changed or obj in changed):
            field.simplify(obj, properties.read(own), depsgraph)


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
