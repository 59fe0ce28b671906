# SPDX-License-Identifier: GPL-3.0-or-later

import bpy

from .panel import GlimmerPanel, draw_node_input, draw_wrapped, limit_row

# What of a lamp is rendered, by its type; names that a version of Blender lacks are left out.
_PROPERTIES = {
    "POINT": ("shadow_soft_size", "use_soft_falloff"),
    "SPOT": ("shadow_soft_size", "use_soft_falloff", "spot_size", "spot_blend"),
    "SUN": ("angle",),
    "AREA": ("shape", "size", "size_y", "spread"),
}


class GLIMMER_PT_light(GlimmerPanel, bpy.types.Panel):
    bl_label = "Light"
    bl_context = "data"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.light is not None

    def draw(self, context: bpy.types.Context) -> None:
        layout, light = self.layout, context.light
        layout.row().prop(light, "type", expand=True)
        layout.use_property_split = True
        if "use_temperature" in light.bl_rna.properties:  # 4.5
            limit_row(layout, light, "use_temperature", "temperature")
        layout.prop(light, "color")
        layout.prop(light, "energy", text="Strength" if light.type == "SUN" else "Power")
        for name in ("exposure", "normalize", *_PROPERTIES[light.type]):
            if name == "size_y" and light.shape not in ("RECTANGLE", "ELLIPSE"):
                continue
            if name in light.bl_rna.properties:
                text = "Radius" if name == "shadow_soft_size" else None
                layout.prop(light, name, text=text)


class GLIMMER_PT_light_options(GlimmerPanel, bpy.types.Panel):
    """Cycles' own, which are there while its add-on is."""

    bl_label = "Options"
    bl_parent_id = "GLIMMER_PT_light"
    bl_context = "data"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.light is not None

    def draw(self, context: bpy.types.Context) -> None:
        layout, light = self.layout, context.light
        layout.use_property_split = True
        cycles = getattr(light, "cycles", None)
        is_portal = light.type == "AREA" and getattr(cycles, "is_portal", False)
        column = layout.column()
        column.active = not is_portal
        if bpy.app.version >= (4, 2):
            column.prop(light, "use_shadow", text="Cast Shadow")
        elif cycles is not None:
            column.prop(cycles, "cast_shadow", text="Cast Shadow")
        if cycles is None:
            draw_wrapped(layout, context, "More options with the add-on Cycles, which is switched off", "INFO")
            return
        column.prop(cycles, "max_bounces")
        if light.type == "AREA":
            layout.prop(cycles, "is_portal", text="Portal")
        if light.type == "SPOT" and light.use_square:
            layout.prop(light, "use_square", text="Square: not rendered")


class GLIMMER_PT_light_nodes(GlimmerPanel, bpy.types.Panel):
    bl_label = "Nodes"
    bl_context = "data"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and context.light is not None

    def draw(self, context: bpy.types.Context) -> None:
        light = context.light
        self.layout.use_property_split = True
        if light.use_nodes and light.node_tree is not None:
            draw_node_input(self.layout, light.node_tree, "Surface")
        else:
            self.layout.prop(light, "use_nodes", icon="NODETREE")


_CLASSES = (GLIMMER_PT_light, GLIMMER_PT_light_options, GLIMMER_PT_light_nodes)

register, unregister = bpy.utils.register_classes_factory(_CLASSES)
