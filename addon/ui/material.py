# SPDX-License-Identifier: GPL-3.0-or-later

import bpy

from .panel import GlimmerPanel, draw_node_input


class GLIMMER_PT_surface(GlimmerPanel, bpy.types.Panel):
    bl_label = "Surface"
    bl_context = "material"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.material is not None

    def draw(self, context: bpy.types.Context) -> None:
        material = context.material
        self.layout.use_property_split = True
        if material.use_nodes:
            draw_node_input(self.layout, material.node_tree, "Surface")
            return
        self.layout.prop(material, "use_nodes", icon="NODETREE")
        for name in ("diffuse_color", "metallic", "roughness"):
            self.layout.prop(material, name)


def register() -> None:
    bpy.utils.register_class(GLIMMER_PT_surface)


def unregister() -> None:
    bpy.utils.unregister_class(GLIMMER_PT_surface)
