# SPDX-License-Identifier: GPL-3.0-or-later

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


class GLIMMER_PT_volume(_MaterialPanel, bpy.types.Panel):
    bl_label = "Volume"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.material.use_nodes

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        draw_node_input(self.layout, context.material.node_tree, "Volume")


class GLIMMER_PT_displacement(_MaterialPanel, bpy.types.Panel):
    bl_label = "Displacement"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.material.use_nodes

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        draw_node_input(self.layout, context.material.node_tree, "Displacement")


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


def register() -> None:
    for panel in _CLASSES:
        bpy.utils.register_class(panel)


def unregister() -> None:
    for panel in reversed(_CLASSES):
        bpy.utils.unregister_class(panel)
