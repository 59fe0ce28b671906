# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's and Cycles' own settings of motion blur, which Glimmer reads."""

import bpy

from .panel import GlimmerPanel


class GLIMMER_PT_motion_blur(GlimmerPanel, bpy.types.Panel):
    bl_label = "Motion Blur"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context: bpy.types.Context) -> None:
        self.layout.prop(context.scene.render, "use_motion_blur", text="")

    def draw(self, context: bpy.types.Context) -> None:
        layout, render = self.layout, context.scene.render
        layout.use_property_split = True
        layout.use_property_decorate = False
        layout.active = render.use_motion_blur
        owner = render if hasattr(render, "motion_blur_position") else getattr(context.scene, "cycles", None)  # 4.2
        if owner is not None:
            layout.prop(owner, "motion_blur_position", text="Position")
        layout.prop(render, "motion_blur_shutter")
        cycles = getattr(context.scene, "cycles", None)
        if getattr(cycles, "rolling_shutter_type", "NONE") != "NONE":
            layout.prop(cycles, "rolling_shutter_type", text="Rolling: not rendered")


class GLIMMER_PT_shutter_curve(GlimmerPanel, bpy.types.Panel):
    bl_label = "Shutter Curve"
    bl_parent_id = "GLIMMER_PT_motion_blur"
    bl_context = "render"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout, render = self.layout, context.scene.render
        layout.active = render.use_motion_blur
        layout.template_curve_mapping(render, "motion_blur_shutter_curve")


class GLIMMER_PT_object_motion_blur(GlimmerPanel, bpy.types.Panel):
    bl_label = "Motion Blur"
    bl_context = "object"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        kinds = {"MESH", "CURVE", "SURFACE", "META", "FONT", "CAMERA", "EMPTY"}
        return super().poll(context) and hasattr(context.object, "cycles") and context.object.type in kinds

    def draw_header(self, context: bpy.types.Context) -> None:
        self.layout.prop(context.object.cycles, "use_motion_blur", text="")

    def draw(self, context: bpy.types.Context) -> None:
        layout, settings = self.layout, context.object.cycles
        layout.use_property_split = True
        layout.active = context.scene.render.use_motion_blur and settings.use_motion_blur
        if context.object.type not in ("CAMERA", "EMPTY"):
            layout.prop(settings, "use_deform_motion", text="Deformation")
        layout.prop(settings, "motion_steps", text="Steps")


_CLASSES = (GLIMMER_PT_motion_blur, GLIMMER_PT_shutter_curve, GLIMMER_PT_object_motion_blur)

register, unregister = bpy.utils.register_classes_factory(_CLASSES)
