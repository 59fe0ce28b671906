# SPDX-License-Identifier: GPL-3.0-or-later
"""Panoramas, and depth of field: Blender's panels belong to EEVEE and Workbench."""

import bpy

from ..export.panorama import SETTINGS, settings_of
from .panel import GlimmerPanel, draw_wrapped


class GLIMMER_PT_panorama(GlimmerPanel, bpy.types.Panel):
    bl_label = "Panorama"
    bl_context = "data"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.camera is not None and context.camera.type == "PANO"

    def draw(self, context: bpy.types.Context) -> None:
        layout, settings = self.layout, settings_of(context.camera)
        layout.use_property_split = True
        if settings is None:
            draw_wrapped(
                layout, context, "Its settings are those of the add-on Cycles Render Engine: enable it", "ERROR"
            )
            return
        layout.prop(settings, "panorama_type", text="Type")
        for name in SETTINGS.get(settings.panorama_type, ()):
            layout.prop(settings, name)


class GLIMMER_PT_depth_of_field(GlimmerPanel, bpy.types.Panel):
    bl_label = "Depth of Field"
    bl_context = "data"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.camera is not None

    def draw_header(self, context: bpy.types.Context) -> None:
        self.layout.prop(context.camera.dof, "use_dof", text="")

    def draw(self, context: bpy.types.Context) -> None:
        layout, dof = self.layout, context.camera.dof
        layout.use_property_split = True
        layout.active = dof.use_dof
        layout.prop(dof, "focus_object", text="Focus on Object")
        if "focus_subtarget" in dof.bl_rna.properties and dof.focus_object and dof.focus_object.type == "ARMATURE":
            layout.prop_search(dof, "focus_subtarget", dof.focus_object.data, "bones", text="Focus on Bone")
        distance = layout.column()
        distance.active = dof.focus_object is None
        distance.prop(dof, "focus_distance", text="Focus Distance")
        for name in ("aperture_fstop", "aperture_blades", "aperture_rotation", "aperture_ratio"):
            layout.prop(dof, name)


register, unregister = bpy.utils.register_classes_factory((GLIMMER_PT_panorama, GLIMMER_PT_depth_of_field))
