# SPDX-License-Identifier: GPL-3.0-or-later

import bpy

from .panel import GlimmerPanel, draw_node_input


class _WorldPanel(GlimmerPanel):
    bl_context = "world"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.world is not None


class GLIMMER_PT_world_surface(_WorldPanel, bpy.types.Panel):
    bl_label = "Surface"

    def draw(self, context: bpy.types.Context) -> None:
        world = context.world
        self.layout.use_property_split = True
        if world.use_nodes:
            draw_node_input(self.layout, world.node_tree, "Surface")
            return
        self.layout.prop(world, "use_nodes", icon="NODETREE")
        self.layout.prop(world, "color")


class GLIMMER_PT_world_volume(_WorldPanel, bpy.types.Panel):
    bl_label = "Haze"

    def draw(self, context: bpy.types.Context) -> None:
        world = context.world
        self.layout.use_property_split = True
        if world.use_nodes:
            draw_node_input(self.layout, world.node_tree, "Volume")
        else:
            self.layout.label(text="Haze needs the world's nodes", icon="INFO")


_CLASSES = (GLIMMER_PT_world_surface, GLIMMER_PT_world_volume)


def register() -> None:
    for panel in _CLASSES:
        bpy.utils.register_class(panel)


def unregister() -> None:
    for panel in reversed(_CLASSES):
        bpy.utils.unregister_class(panel)
