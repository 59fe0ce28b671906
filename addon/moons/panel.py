# SPDX-License-Identifier: GPL-3.0-or-later
"""Radius, colour and radiance of a moon in its data properties."""

from typing import Any

import bpy

from .moon import emission_node


class GLIMMER_PT_moon(bpy.types.Panel):
    bl_label = "Moon"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "data"

    @classmethod
    def poll(cls, context: Any) -> bool:
        return emission_node(context.object) is not None

    def draw(self, context: Any) -> None:
        layout = self.layout
        layout.use_property_split = True
        node = emission_node(context.object)
        layout.prop(context.object.glimmer_moon, "radius")
        layout.prop(node.inputs["Color"], "default_value", text="Color")
        layout.prop(node.inputs["Strength"], "default_value", text="Radiance")


def register() -> None:
    bpy.utils.register_class(GLIMMER_PT_moon)


def unregister() -> None:
    bpy.utils.unregister_class(GLIMMER_PT_moon)
