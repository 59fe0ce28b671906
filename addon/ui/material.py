# SPDX-License-Identifier: GPL-3.0-or-later

from typing import Any

import bpy

from .panel import GlimmerPanel, draw_node_input


class _MaterialPanel(GlimmerPanel):
    bl_context = "material"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.material is not None


class GLIMMER_PT_surface(_MaterialPanel, bpy.types.Panel):
    bl_label = "Surface"

    def draw(self, context: bpy.types.Context) -> None:
        material = context.material
        self.layout.use_property_split = True
        if material.use_nodes:
            draw_node_input(self.layout, material.node_tree, "Surface")
            return
        self.layout.prop(material, "use_nodes", icon="NODETREE")
        for name in ("diffuse_color", "metallic", "roughness"):
            self.layout.prop(material, name)


class _InputPanel(_MaterialPanel):
    """What is linked to the output's input of the panel's name."""

    bl_label = ""
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.material.use_nodes

    def draw(self: Any, context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        draw_node_input(self.layout, context.material.node_tree, self.bl_label)


class GLIMMER_PT_volume(_InputPanel, bpy.types.Panel):
    bl_label = "Volume"


class GLIMMER_PT_displacement(_InputPanel, bpy.types.Panel):
    bl_label = "Displacement"


class GLIMMER_PT_material_settings(_MaterialPanel, bpy.types.Panel):
    bl_label = "Settings"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        material = context.material
        self.layout.use_property_split = True
        self.layout.prop(material, "pass_index")
        owner = material if hasattr(material, "displacement_method") else getattr(material, "cycles", None)  # 4.1
        if owner is not None:
            self.layout.prop(owner, "displacement_method", text="Displacement")
        cycles = getattr(material, "cycles", None)
        if hasattr(cycles, "use_bump_map_correction"):  # 4.4
            self.layout.prop(cycles, "use_bump_map_correction")


_CLASSES = (GLIMMER_PT_surface, GLIMMER_PT_volume, GLIMMER_PT_displacement, GLIMMER_PT_material_settings)

register, unregister = bpy.utils.register_classes_factory(_CLASSES)
