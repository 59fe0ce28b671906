# SPDX-License-Identifier: GPL-3.0-or-later
"""The sliders of a world in the sidebar of the viewport: of its field, its haze, its moons and its camera."""

from typing import Any

import bpy

from ..haze import nodes
from ..moons.moon import emission_node

# Of the field; what one changes most.
SLIDERS = (
    "seed",
    "radius",
    "planet_radius",
    "hill_kind",
    "hill_height",
    "hill_wavelength",
    "cracked",
    "missing",
    "second_weight",
    "patina",
    "viewport_share",
)


def field_of(scene: Any) -> Any:
    """The first hexagon field of the scene, or None."""
    return next((obj for obj in scene.objects if obj.type == "MESH" and obj.glimmer_field.enabled), None)


class GLIMMER_PT_world_sidebar(bpy.types.Panel):
    bl_label = "Glimmer World"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Glimmer"
    bl_order = 0

    def draw(self, context: Any) -> None:
        layout, scene = self.layout, context.scene
        layout.use_property_split = True
        layout.operator_menu_enum("glimmer.add_glimmer_world", "preset", text="Add World", icon="WORLD")
        land = field_of(scene)
        if land is not None:
            column = layout.column()
            for name in SLIDERS:
                if name != "radius" or land.glimmer_field.extent == "RADIUS":
                    column.prop(land.glimmer_field, name)
        haze = nodes.node_of(scene.world)
        if haze is not None:
            column = layout.column()
            column.prop(scene.world.glimmer_haze, "visual_range")
            column.prop(haze.inputs["Color"], "default_value", text="Haze Color")
            column.prop(haze.inputs["Anisotropy"], "default_value", text="Anisotropy")
        column = layout.column()
        for obj in scene.objects:
            node = emission_node(obj)
            if node is not None and "Strength" in node.inputs:
                column.prop(node.inputs["Strength"], "default_value", text=obj.name)
        layout.prop(scene.view_settings, "exposure")
        row = layout.row(align=True)
        for name in ("best_view", "fly_over", "orbit_camera"):
            row.operator(f"glimmer.{name}")


_CLASSES = (GLIMMER_PT_world_sidebar,)

register, unregister = bpy.utils.register_classes_factory(_CLASSES)
