# SPDX-License-Identifier: GPL-3.0-or-later
"""Which rays meet an object or the world: Blender's and Cycles' own settings."""

import bpy

from ..export.visibility import OF_OBJECT, OF_WORLD
from .panel import GlimmerPanel, draw_wrapped


class _ObjectPanel(GlimmerPanel):
    bl_context = "object"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        item = context.object
        return super().poll(context) and item is not None and item.type not in ("CAMERA", "ARMATURE", "SPEAKER")


class GLIMMER_PT_ray_visibility(_ObjectPanel, bpy.types.Panel):
    bl_label = "Ray Visibility"

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        column = self.layout.column(heading="Seen by")
        for name in OF_OBJECT:
            column.prop(context.object, name)
        column = self.layout.column(heading="Mask")
        if context.object.type != "LIGHT":
            column.prop(context.object, "is_holdout")
            if context.object.is_shadow_catcher:
                column.prop(context.object, "is_shadow_catcher", text="Shadow Catcher: not rendered")


class GLIMMER_PT_shadow_terminator(_ObjectPanel, bpy.types.Panel):
    bl_label = "Shadow Terminator"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.object.type != "LIGHT"

    def draw(self, context: bpy.types.Context) -> None:
        layout, item = self.layout, context.object
        layout.use_property_split = True
        own = hasattr(item, "shadow_terminator_geometry_offset")  # of Blender; before, of the add-on Cycles
        settings = item if own else getattr(item, "cycles", None)
        if settings is None:
            draw_wrapped(layout, context, "These settings belong to the add-on Cycles, which is switched off", "INFO")
            return
        layout.prop(settings, "shadow_terminator_geometry_offset", text="Geometry Offset")
        shading = "shadow_terminator_shading_offset" if own else "shadow_terminator_offset"
        if getattr(settings, shading) > 0:
            layout.prop(settings, shading, text="Shading Offset: not rendered")


class GLIMMER_PT_world_ray_visibility(GlimmerPanel, bpy.types.Panel):
    bl_label = "Ray Visibility"
    bl_context = "world"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.world is not None

    def draw(self, context: bpy.types.Context) -> None:
        layout, world = self.layout, context.world
        layout.use_property_split = True
        settings = getattr(world, "cycles_visibility", None)
        if settings is None:
            draw_wrapped(layout, context, "These settings belong to the add-on Cycles, which is switched off", "INFO")
            return
        column = layout.column(heading="Seen by")
        for name in OF_WORLD:
            column.prop(settings, name)
        if world.cycles.max_bounces < world.cycles.bl_rna.properties["max_bounces"].default:
            layout.prop(world.cycles, "max_bounces", text="Max Bounces: not rendered")


_CLASSES = (GLIMMER_PT_ray_visibility, GLIMMER_PT_shadow_terminator, GLIMMER_PT_world_ray_visibility)

register, unregister = bpy.utils.register_classes_factory(_CLASSES)
