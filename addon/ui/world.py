# SPDX-License-Identifier: GPL-3.0-or-later

import bpy

from ..haze import nodes as haze
from .panel import GlimmerPanel, draw_node_input


class _WorldPanel(GlimmerPanel):
    bl_context = "world"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.world is not None


class GLIMMER_PT_world_preview(_WorldPanel, bpy.types.Panel):
    bl_label = "Preview"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.template_preview(context.world)


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
        layout, world = self.layout, context.world
        layout.use_property_split = True
        node = haze.node_of(world)
        if node is not None:
            layout.prop(world.glimmer_haze, "visual_range")
            for name in ("Color", "Anisotropy"):
                layout.prop(node.inputs[name], "default_value", text=name)
        elif not _has_volume(world):
            layout.operator("glimmer.add_haze", text="Add Haze", icon="ADD")


class GLIMMER_PT_world_volume_nodes(_WorldPanel, bpy.types.Panel):
    bl_label = "Volume Nodes"
    bl_parent_id = "GLIMMER_PT_world_volume"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.world.use_nodes

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        draw_node_input(self.layout, context.world.node_tree, "Volume")


class GLIMMER_PT_world_light_group(_WorldPanel, bpy.types.Panel):
    bl_label = "Light Group"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        self.layout.prop_search(context.world, "lightgroup", context.view_layer, "lightgroups", text="Light Group")


class GLIMMER_PT_world_mist(_WorldPanel, bpy.types.Panel):
    bl_label = "Mist Pass"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        for name in ("start", "depth", "falloff"):
            self.layout.prop(context.world.mist_settings, name)


def _has_volume(world: bpy.types.World) -> bool:
    output = world.node_tree.get_output_node("CYCLES") if world.use_nodes and world.node_tree is not None else None
    return output is not None and output.inputs["Volume"].is_linked


_CLASSES = (
    GLIMMER_PT_world_preview,
    GLIMMER_PT_world_surface,
    GLIMMER_PT_world_volume,
    GLIMMER_PT_world_volume_nodes,
    GLIMMER_PT_world_mist,
    GLIMMER_PT_world_light_group,
)

register, unregister = bpy.utils.register_classes_factory(_CLASSES)
