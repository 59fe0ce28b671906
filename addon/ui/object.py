# SPDX-License-Identifier: GPL-3.0-or-later

import bpy
import numpy as np

from ..export.sphere import NotASphereError, read_sphere
from .panel import GlimmerPanel

MOST_VERTICES = 100_000  # that a panel reads each time it is drawn


class GLIMMER_PT_object(GlimmerPanel, bpy.types.Panel):
    bl_label = "Analytic Sphere"
    bl_context = "object"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        item = context.object
        return super().poll(context) and item is not None and item.type == "MESH" and not item.glimmer_field.enabled

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        self.layout.prop(context.object.glimmer, "is_sphere", text="Render as a Sphere")
        why = why_no_sphere(context) if context.object.glimmer.is_sphere else ""
        if why:
            self.layout.label(text=why, icon="ERROR")
            self.layout.label(text="Rendered as the mesh that it is", icon="BLANK1")


class GLIMMER_PT_object_light_group(GlimmerPanel, bpy.types.Panel):
    bl_label = "Light Group"
    bl_context = "object"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.object is not None

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        self.layout.prop_search(context.object, "lightgroup", context.view_layer, "lightgroups", text="Light Group")


def why_no_sphere(context: bpy.types.Context) -> str:
    """As an export would find it; empty where it is one, or too large to look at."""
    item = context.object.evaluated_get(context.evaluated_depsgraph_get())
    if len(item.data.vertices) > MOST_VERTICES:
        return ""
    try:
        sphere = read_sphere(item)
        if sphere is not None:
            sphere.placed(np.array(item.matrix_world, np.float64)[np.newaxis])
    except NotASphereError as why:
        return f"It {str(why).partition('; ')[0]}"
    return ""


def register() -> None:
    bpy.utils.register_class(GLIMMER_PT_object)
    bpy.utils.register_class(GLIMMER_PT_object_light_group)


def unregister() -> None:
    bpy.utils.unregister_class(GLIMMER_PT_object_light_group)
    bpy.utils.unregister_class(GLIMMER_PT_object)
