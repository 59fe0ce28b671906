# SPDX-License-Identifier: GPL-3.0-or-later

import bpy

from ..film import cryptomatte
from ..film.passes import LONG_NAMES, OPTIONAL
from .panel import GlimmerPanel, draw_wrapped


class GLIMMER_PT_filter(GlimmerPanel, bpy.types.Panel):
    bl_label = "Filter"
    bl_context = "view_layer"

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        column, view_layer = self.layout.column(heading="Include"), context.view_layer
        column.prop(view_layer, "use_sky", text="Environment")
        column.prop(view_layer, "use_solid", text="Surfaces")
        column.prop(view_layer, "use_strand", text="Hair")
        column.prop(view_layer, "use_volumes", text="Volumes")


class GLIMMER_PT_passes(GlimmerPanel, bpy.types.Panel):
    bl_label = "Passes"
    bl_context = "view_layer"

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        column = self.layout.column(heading="Include")
        drawn = set()
        for item in OPTIONAL:
            owner = item.owner(context.view_layer)
            if owner is None or item.switch in drawn:
                continue  # Cycles is switched off, or one switch is of several passes
            drawn.add(item.switch)
            text = "Denoising Data" if item.switch == "denoising_store_passes" else item.name(LONG_NAMES)
            column.prop(owner, item.switch, text=text)
        if context.view_layer.use_pass_ambient_occlusion and context.scene.world is not None:
            self.layout.prop(context.scene.world.light_settings, "distance", text="Occlusion Distance")


class GLIMMER_PT_cryptomatte(GlimmerPanel, bpy.types.Panel):
    bl_label = "Cryptomatte"
    bl_context = "view_layer"
    bl_parent_id = "GLIMMER_PT_passes"

    def draw(self, context: bpy.types.Context) -> None:
        layout, view_layer = self.layout, context.view_layer
        layout.use_property_split = True
        layout.use_property_decorate = False
        column = layout.column(heading="Include")
        for kind in cryptomatte.KINDS:
            column.prop(view_layer, f"use_pass_cryptomatte_{kind}", text=kind.capitalize())
        layout.prop(view_layer, "pass_cryptomatte_depth", text="Levels")


class GLIMMER_PT_aovs(GlimmerPanel, bpy.types.Panel):
    bl_label = "Shader AOV"
    bl_context = "view_layer"
    bl_parent_id = "GLIMMER_PT_passes"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        view_layer, row = context.view_layer, self.layout.row()
        row.template_list("VIEWLAYER_UL_aov", "aovs", view_layer, "aovs", view_layer, "active_aov_index", rows=3)
        column = row.column(align=True)
        column.operator("scene.view_layer_add_aov", icon="ADD", text="")
        column.operator("scene.view_layer_remove_aov", icon="REMOVE", text="")


class GLIMMER_PT_light_groups(GlimmerPanel, bpy.types.Panel):
    bl_label = "Light Groups"
    bl_context = "view_layer"
    bl_parent_id = "GLIMMER_PT_passes"

    def draw(self, context: bpy.types.Context) -> None:
        view_layer, row = context.view_layer, self.layout.row()
        row.template_list(
            "UI_UL_list", "lightgroups", view_layer, "lightgroups", view_layer, "active_lightgroup_index", rows=3
        )
        column = row.column(align=True)
        column.operator("scene.view_layer_add_lightgroup", icon="ADD", text="")
        column.operator("scene.view_layer_remove_lightgroup", icon="REMOVE", text="")
        if view_layer.lightgroups:
            draw_wrapped(
                self.layout, context, "Light in haze is followed path by path then, which takes longer", "INFO"
            )


class GLIMMER_PT_view_layer_override(GlimmerPanel, bpy.types.Panel):
    bl_label = "Override"
    bl_context = "view_layer"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        self.layout.prop(context.view_layer, "material_override", text="Material")
        self.layout.prop(context.view_layer, "use_motion_blur", text="Motion Blur")
        self.layout.prop(context.view_layer, "samples")
        cycles = getattr(context.scene, "cycles", None)
        if hasattr(cycles, "use_layer_samples"):
            self.layout.prop(cycles, "use_layer_samples")


_CLASSES = (
    GLIMMER_PT_filter,
    GLIMMER_PT_passes,
    GLIMMER_PT_cryptomatte,
    GLIMMER_PT_aovs,
    GLIMMER_PT_light_groups,
    GLIMMER_PT_view_layer_override,
)

register, unregister = bpy.utils.register_classes_factory(_CLASSES)
